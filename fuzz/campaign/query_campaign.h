// The query properties as parts of a campaign: a stream for every class and kind, and gates on what its cases come to.
#pragma once

#include "fuzz/campaign/property.h"
#include "fuzz/draw/generators.h"
#include "fuzz/oracle/query_property.h"

namespace selvage::fuzz {

/// The counters of a query campaign: places in Counts::of.
enum QueryCounter : std::uint8_t { kTouches, kHits, kAlarms, kUnresolved, kUndecided, kDecidedExactly };

/// A promise about queries, asked of `kernel`.
[[nodiscard]] std::unique_ptr<Property> make_query_campaign(const QueryProperty& property,
                                                            CcdKernel kernel = selvage_kernel);

/// Whether the share of exact touches (hits, for a class that aims at the end) is outside the class's band by more than
/// chance (5 standard deviations) explains: a dead or drifted generator (F1). REQUIRES counts of the property `ccd`.
[[nodiscard]] bool is_out_of_band(const QueryClass& query_class, PairKind kind, const Counts& counts);

/// Whether more of the answers were `unresolved`, at the default limit, than a useful kernel needs, beyond chance:
/// without this gate "unresolved" to everything would keep every promise.
[[nodiscard]] bool is_unresolved_too_often(PairKind kind, const Counts& counts);

}  // namespace selvage::fuzz
