#include "fuzz/run/records.h"

#include <algorithm>
#include <optional>

namespace selvage::fuzz {
namespace {

/// Of queries that do not touch: below this many a share is chance.
constexpr std::int64_t kEnough = 100;

struct Measured {
  const PropertyLedger& property;
  std::size_t touches, exact;  // places of the counters

  [[nodiscard]] double nearest(const Counts& counts) const { return static_cast<double>(counts.nearest_bits); }
  [[nodiscard]] double unfiltered(const Counts& counts) const {
    const std::int64_t apart = counts.cases - counts.of[touches];
    if (apart < kEnough) return 0;
    return static_cast<double>(counts.of[exact] - counts.of[touches]) / static_cast<double>(apart);
  }
};

std::optional<std::size_t> place_of(const PropertyLedger& property, std::string_view counter) {
  const auto found = std::ranges::find(property.counters, counter);
  if (found == property.counters.end()) return std::nullopt;
  return static_cast<std::size_t>(found - property.counters.begin());
}

}  // namespace

std::vector<SharpnessRecord> sharpness_records(const PropertyLedger& property) {
  const auto touches = place_of(property, "touches"), exact = place_of(property, "exact");
  if (!touches || !exact) return {};
  const Measured measured{property, *touches, *exact};
  std::vector<SharpnessRecord> records;
  const auto offer = [&](const char* measure, const std::string& stream, double value) {
    if (!(value > 0)) return;
    const std::size_t space = stream.find(' ');
    const std::string kind = stream.substr(space + 1), of_class = stream.substr(0, space);
    const auto is_same = [&](const SharpnessRecord& r) { return r.measure == measure && r.kind == kind; };
    auto record = std::ranges::find_if(records, is_same);
    if (record == records.end()) record = records.insert(record, {measure, kind, {}, 0});
    if (value > record->value) *record = {measure, kind, {}, value};
    if (value == record->value) record->classes.push_back(of_class);
  };
  for (std::size_t i = 0; i < property.rows.size(); ++i) {
    offer("nearest", property.streams[i], measured.nearest(property.rows[i]));
    offer("unfiltered", property.streams[i], measured.unfiltered(property.rows[i]));
  }
  return records;
}

}  // namespace selvage::fuzz
