#include "fuzz/campaign_stats.h"

#include <nlohmann/json.hpp>

namespace selvage::fuzz {

std::string stats_line(const Ledger& ledger, const DriverStatus& status) {
  nlohmann::ordered_json line;
  line["seconds"] = status.seconds;
  line["processor_seconds"] = status.processor_seconds;
  line["cases"] = status.cases;
  line["cases_per_second"] = status.seconds > 0 ? static_cast<double>(status.cases) / status.seconds : 0;
  for (const PropertyLedger& property : ledger.properties) {
    const Counts total = property.total();
    nlohmann::ordered_json& one = line["properties"][property.name];
    one["units"] = property.units.size();
    one["cases"] = total.cases;
    for (std::size_t i = 0; i < property.counters.size(); ++i) one[property.counters[i]] = total.of[i];
    one["nearest_bits"] = total.nearest_bits;
    one["failures"] = nlohmann::ordered_json::object();
    for (const auto& [key, finding] : property.findings) {
      nlohmann::ordered_json& sum = one["failures"][key.second];
      sum = finding.count + (sum.is_null() ? 0 : sum.get<std::int64_t>());
    }
  }
  return line.dump() + "\n";
}

}  // namespace selvage::fuzz
