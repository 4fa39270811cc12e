#include "fuzz/run/campaign_stats.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>

#include <nlohmann/json.hpp>

#include "fuzz/run/records.h"

namespace selvage::fuzz {
namespace {

void add_failures(const PropertyLedger& property, std::map<std::string, std::int64_t>& by_kind) {
  for (const auto& [key, finding] : property.findings) by_kind[key.second] += finding.count;
}

/// Three or four digits: 987, 12.3k, 4.56M.
std::string brief(double x) {
  constexpr std::array<const char*, 4> kUnits{"", "k", "M", "G"};
  std::size_t unit = 0;
  for (; x >= 1000 && unit + 1 < kUnits.size(); ++unit) x /= 1000;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), unit == 0 ? "%.0f%s" : "%.3g%s", x, kUnits[unit]);
  return text.data();
}

}  // namespace

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
    for (const SharpnessRecord& record : sharpness_records(property)) {
      one["records"][record.measure][record.kind] = {{"value", record.value}, {"classes", record.classes}};
    }
    std::map<std::string, std::int64_t> failures;
    add_failures(property, failures);
    one["failures"] = failures;
  }
  return line.dump() + "\n";
}

std::string status_line(const Ledger& ledger, const DriverStatus& status) {
  std::map<std::string, std::int64_t> counted, failures;
  std::int64_t nearest_bits = 0;
  for (const PropertyLedger& property : ledger.properties) {
    const Counts total = property.total();
    for (std::size_t i = 0; i < property.counters.size(); ++i) counted[property.counters[i]] += total.of[i];
    nearest_bits = std::max(nearest_bits, total.nearest_bits);
    add_failures(property, failures);
  }
  const auto cases = static_cast<double>(status.cases);
  std::string text = brief(status.seconds) + " s: " + brief(cases) + " cases, " +
                     brief(status.seconds > 0 ? cases / status.seconds : 0) + " a second";
  for (const char* name : {"hits", "alarms", "exact"}) {
    const auto found = counted.find(name);
    if (found != counted.end()) text += ", " + brief(static_cast<double>(found->second)) + " " + name;
  }
  if (nearest_bits > 0) text += ", nearest 2^-" + std::to_string(nearest_bits);
  for (const auto& [kind, count] : failures) text += ", " + std::to_string(count) + " " + kind;
  return failures.empty() ? text + ", no failure" : text;
}

}  // namespace selvage::fuzz
