#include "fuzz/ledger/ledger.h"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>

namespace selvage::fuzz {
namespace {

[[noreturn]] void refuse(const std::string& why) { throw io::Error(io::ErrorKind::kBadInput, "merge: " + why); }

/// In what two shards are not of one campaign, in the words of the command line; "" where they are.
std::string_view difference(const Ledger& a, const Ledger& b) {
  const auto same = [](const PropertyLedger& p, const PropertyLedger& q) {
    return p.name == q.name && p.streams == q.streams && p.counters == q.counters;
  };
  if (a.version != b.version) return "the version of the program";
  if (a.target != b.target || a.plugin_crc32 != b.plugin_crc32) return "the code under test (--plugin)";
  if (a.seed != b.seed) return "--seed";
  if (a.cases != b.cases) return "--cases";
  if (a.shards != b.shards) return "the number of shards (--shard i/N)";
  if (!std::ranges::equal(a.properties, b.properties, same)) return "the properties that were named";
  return "";
}

void add(PropertyLedger& to, const PropertyLedger& from) {
  for (const auto& [begin, end] : from.units.ranges()) {
    if (!to.units.insert(begin, end))
      refuse("two shards hold the same work unit of " + to.name + "; name each folder once");
  }
  to.open.insert(from.open.begin(), from.open.end());
  for (std::size_t i = 0; i < to.rows.size(); ++i) to.rows[i] += from.rows[i];
  for (std::size_t i = 0; i < to.accuracy.size(); ++i) to.accuracy[i] += from.accuracy[i];
  for (const auto& [key, finding] : from.findings) {
    const auto [place, is_new] = to.findings.try_emplace(key, finding);
    if (is_new) continue;
    const std::int64_t count = place->second.count + finding.count;
    if (finding.number < place->second.number) place->second = finding;
    place->second.count = count;
  }
}

}  // namespace

std::int64_t PropertyLedger::streams_without_cases() const {
  return std::ranges::count(rows, std::int64_t{0}, &Counts::cases);
}

Counts PropertyLedger::total() const {
  Counts sum;
  for (const Counts& row : rows) sum += row;
  return sum;
}

Accuracy PropertyLedger::total_accuracy() const {
  Accuracy sum;
  for (const Accuracy& row : accuracy) sum += row;
  return sum;
}

Ledger merge(const std::vector<Ledger>& parts) {
  if (parts.empty()) refuse("there is no shard");
  Ledger merged = parts.front();
  merged.shard = merged.shards = 1;
  std::set<std::int64_t> shards{parts.front().shard};
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::string own = std::to_string(parts[i].shard);
    if (const std::string_view what = difference(parts.front(), parts[i]); !what.empty()) {
      refuse("shards " + std::to_string(parts.front().shard) + " and " + own + " differ in " + std::string(what) +
             "; run every shard with the same options");
    }
    if (!shards.insert(parts[i].shard).second) refuse("shard " + own + " is there twice; name its folder once");
    for (std::size_t p = 0; p < merged.properties.size(); ++p) add(merged.properties[p], parts[i].properties[p]);
  }
  for (std::int64_t shard = 1; shard <= parts.front().shards; ++shard) {
    if (!shards.contains(shard)) {
      const std::string name = std::to_string(shard) + "/" + std::to_string(parts.front().shards);
      refuse("shard " + name + " is missing; run it with --shard " + name + ", and name its folder too");
    }
  }
  return merged;
}

}  // namespace selvage::fuzz
