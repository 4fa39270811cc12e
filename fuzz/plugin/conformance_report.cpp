#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "fuzz/base/deaths.h"
#include "fuzz/plugin/conformance.h"

namespace selvage::fuzz {
namespace {

std::string line(const std::string& name, const Counts& counts) {
  std::array<char, 200> text{};
  const ConformanceRow row(counts);
  std::snprintf(text.data(), text.size(), "  %-38s %10lld %9lld %9lld %8lld %8lld %8lld %10.0f\n", name.c_str(),
                static_cast<long long>(row.queries), static_cast<long long>(row.touches),
                static_cast<long long>(row.alarms), static_cast<long long>(row.missed),
                static_cast<long long>(row.late), static_cast<long long>(row.too_far), row.nanoseconds_per_query());
  return text.data();
}

bool has_hung(const PropertyLedger& done) {
  return std::ranges::any_of(done.findings, [](const auto& finding) { return finding.first.second == kHung; });
}

}  // namespace

ConformanceRow::ConformanceRow(const Counts& counts)
    : queries(counts.cases),
      touches(counts.of[kTouches]),
      alarms(counts.of[kAlarms]),
      missed(counts.of[kMissed]),
      late(counts.of[kLate]),
      too_far(counts.of[kTooFar]),
      misdeeds(counts.failures - missed - late - too_far),
      nanoseconds(counts.of[kNanoseconds]) {}

double ConformanceRow::nanoseconds_per_query() const {
  return queries > 0 ? static_cast<double>(nanoseconds) / static_cast<double>(queries) : 0;
}

std::string conformance_text(const Ledger& ledger, const PluginInfo& info, const std::string& folder) {
  const PropertyLedger& done = ledger.properties.front();
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), "%s, alarms within %.3g + %.3g of the size%s\n", info.name,
                info.gap.tolerance, info.gap.relative_tolerance, info.has_toi ? "" : ", no times of impact");
  std::string report = text.data();
  std::snprintf(text.data(), text.size(), "  %-38s %10s %9s %9s %8s %8s %8s %10s\n", "class", "queries", "touches",
                "alarms", "missed", "late", "too far", "ns a query");
  report += text.data();
  for (std::size_t i = 0; i < done.rows.size(); ++i) report += line(done.streams[i], done.rows[i]);
  report += line("all", done.total()) + accuracy_text(done.total_accuracy());
  for (const auto& [key, finding] : done.findings) {
    report += "  " + key.second + ": " + key.first + ", " + std::to_string(finding.count) + " times, first in case " +
              std::to_string(finding.number) + "; smallest: " + folder + "/" + finding.file + "\n";
  }
  const std::int64_t unasked = done.streams_without_cases();
  if (unasked > 0) {
    report += "  " + std::to_string(unasked) + " of " + std::to_string(done.rows.size()) +
              " classes were asked nothing: nothing is known of them; give it more --time or --cases, or fewer shards" +
              (has_hung(done) ? ", and first mend what hung: it is not asked for ever" : "") + "\n";
  }
  return report + (done.findings.empty() && unasked == 0 ? "  nothing found\n" : "");
}

namespace {

nlohmann::ordered_json json_of(const Spread& spread) {
  return {{"mean", spread.mean},
          {"half", spread.half},
          {"nine_tenths", spread.nine_tenths},
          {"all_but_a_hundredth", spread.all_but_a_hundredth},
          {"worst", spread.worst}};
}

nlohmann::ordered_json json_of(const Accuracy& accuracy) {
  const Spread time = spread_of(accuracy.early_time);
  nlohmann::ordered_json json = {
      {"times", time.count}, {"early_at_most", nullptr}, {"apart", nlohmann::ordered_json::array()}};
  if (time.count > 0) {
    json["early_at_most"] = {{"of_the_step", json_of(time)},
                             {"of_the_size", json_of(spread_of(accuracy.early_distance))}};
  }
  for (std::size_t i = 0; i < accuracy.apart.size(); ++i) {
    const double bound = i < Accuracy::kGaps.size() ? std::ldexp(1, Accuracy::kGaps.at(i)) : 0;
    json["apart"].push_back({{"beyond", bound}, {"cases", accuracy.apart[i]}, {"alarms", accuracy.alarms[i]}});
  }
  return json;
}

}  // namespace

std::string conformance_json(const Ledger& ledger, const PluginInfo& info) {
  const PropertyLedger& done = ledger.properties.front();
  nlohmann::ordered_json json;
  json["schema"] = "selvage.conformance/1";
  json["plugin"] = {{"name", info.name},
                    {"crc32", ledger.plugin_crc32.value()},
                    {"tolerance", info.gap.tolerance},
                    {"relative_tolerance", info.gap.relative_tolerance},
                    {"has_toi", info.has_toi},
                    {"has_batch", info.has_batch}};
  json["seed"] = ledger.seed;
  for (std::size_t i = 0; i < done.rows.size(); ++i) {
    const ConformanceRow row(done.rows[i]);
    json["classes"].push_back({{"name", done.streams[i]},
                               {"queries", row.queries},
                               {"touches", row.touches},
                               {"alarms", row.alarms},
                               {"missed", row.missed},
                               {"late", row.late},
                               {"too_far", row.too_far},
                               {"nanoseconds", row.nanoseconds},
                               {"failures", done.rows[i].failures},
                               {"accuracy", json_of(done.accuracy[i])}});
  }
  json["classes_without_queries"] = done.streams_without_cases();
  json["accuracy"] = json_of(done.total_accuracy());
  json["findings"] = nlohmann::ordered_json::array();
  for (const auto& [key, finding] : done.findings) {
    json["findings"].push_back({{"class", key.first},
                                {"failure", key.second},
                                {"count", finding.count},
                                {"first_case", finding.number},
                                {"smallest", finding.file}});
  }
  return json.dump(1) + "\n";
}

}  // namespace selvage::fuzz
