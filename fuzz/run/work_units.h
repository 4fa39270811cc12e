// Into what the cases of a property are divided, and the ledger in which none of it is done.
#pragma once

#include <cstdint>
#include <optional>

#include "fuzz/campaign/property.h"
#include "fuzz/ledger/ledger.h"

namespace selvage::fuzz {

/// Cases in a work unit.
[[nodiscard]] std::int64_t unit_size(const Property& property);
/// Work units that hold so many cases; nothing where `cases` is 0: without end.
[[nodiscard]] std::optional<std::int64_t> unit_count(const Property& property, std::int64_t cases);

/// An empty ledger for these properties.
[[nodiscard]] Ledger make_ledger(const Properties& properties);

}  // namespace selvage::fuzz
