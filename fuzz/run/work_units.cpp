#include "fuzz/run/work_units.h"

#include <utility>

namespace selvage::fuzz {

std::int64_t unit_size(const Property& property) {
  std::int64_t size = 0;
  for (const Stream& stream : property.streams()) size += stream.per_unit;
  return size;
}

std::optional<std::int64_t> unit_count(const Property& property, std::int64_t cases) {
  if (cases == 0) return std::nullopt;
  const std::int64_t size = unit_size(property);
  return (cases + size - 1) / size;
}

Ledger make_ledger(const Properties& properties) {
  Ledger ledger;
  for (const auto& property : properties) {
    PropertyLedger one{property->name(), {}, {}, property->counters(), {}, {}};
    for (const Stream& stream : property->streams()) one.streams.push_back(stream.name);
    one.rows.resize(one.streams.size());
    one.accuracy.resize(one.streams.size());
    ledger.properties.push_back(std::move(one));
  }
  return ledger;
}

}  // namespace selvage::fuzz
