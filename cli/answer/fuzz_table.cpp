#include "cli/answer/fuzz_table.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "fuzz/draw/generators.h"
#include "fuzz/run/worker.h"
#include "io/file/text.h"

namespace selvage::cli {
namespace {

/// Streams of one group, or all where there are no groups.
struct GroupRow {
  std::string name;
  fuzz::Counts counts;
  int alive = 0, streams = 0;
};

std::string group_name(char letter) {
  const auto& groups = fuzz::query_groups();
  const auto found = std::ranges::find(groups, letter, &fuzz::QueryGroup::letter);
  return found == groups.end() ? "all" : fmt::format("{} {}", letter, found->name);
}

std::string line(const std::string& name, const std::string& alive, const fuzz::Counts& counts, std::size_t used) {
  std::string text = fmt::format("  {:<26} {:>7} {:>12}", name, alive, counts.cases);
  for (std::size_t i = 0; i < used; ++i) text += fmt::format(" {:>11}", counts.of[i]);
  const std::string nearest = counts.nearest_bits > 0 ? fmt::format("2^-{}", counts.nearest_bits) : "";
  return text + fmt::format(" {:>8} {:>8}\n", nearest, counts.failures);
}

std::string reproduce(const fuzz::Property& property, const std::string& stream, const fuzz::Finding& finding,
                      const fuzz::Ledger& ledger, const std::string& folder) {
  std::string text = fmt::format("      selvage fuzz {} --seed {} --only {}:{}\n", property.name(), ledger.seed,
                                 fuzz::stream_word(stream), finding.number);
  if (!finding.file.empty()) {
    text = fmt::format("      selvage replay {}\n",
                       io::printable(io::shell_word(fmt::format("{}/{}", folder, finding.file)))) +
           text;
  }
  return text;
}

}  // namespace

FuzzTable fuzz_table(const fuzz::Ledger& ledger, const fuzz::Properties& properties, const std::string& folder) {
  FuzzTable table;
  for (std::size_t p = 0; p < properties.size(); ++p) {
    const fuzz::Property& property = *properties[p];
    const fuzz::PropertyLedger& done = ledger.properties[p];
    const std::size_t used = done.counters.size();
    table.text +=
        fmt::format("{}: {}\n  {:<26} {:>7} {:>12}", property.name(), property.promise(), "", "alive", "cases");
    for (const std::string& counter : done.counters) table.text += fmt::format(" {:>11}", counter);
    table.text += fmt::format(" {:>8} {:>8}\n", "nearest", "failures");
    std::map<char, GroupRow> groups;
    GroupRow all{"all", {}, 0, 0};
    std::string complaints;
    for (std::size_t i = 0; i < done.rows.size(); ++i) {
      const fuzz::Stream& stream = property.streams()[i];
      const std::string complaint = property.complaint(stream, done.rows[i]);
      if (!complaint.empty()) complaints += fmt::format("  {}: {}\n", stream.name, complaint);
      for (GroupRow* row : {&groups[stream.group], &all}) {
        row->counts += done.rows[i];
        row->streams += 1;
        row->alive += complaint.empty() && done.rows[i].cases > 0 ? 1 : 0;
      }
    }
    const auto print = [&](const std::string& name, const GroupRow& row) {
      table.text += line(name, fmt::format("{}/{}", row.alive, row.streams), row.counts, used);
    };
    if (groups.size() > 1) {
      for (const auto& [letter, row] : groups) print(group_name(letter), row);
    }
    print("all", all);
    table.text += accuracy_text(done.total_accuracy());
    table.text += complaints;
    const std::int64_t unasked = done.streams_without_cases();
    if (unasked > 0) {
      table.text +=
          fmt::format("  {} of {} streams have had no case: nothing is known of them{}\n", unasked, all.streams,
                      ledger.shards > 1 ? " from this shard" : "; give it more --time or --cases");
    }
    table.is_whole = table.is_whole && (ledger.shards > 1 ? all.counts.cases > 0 : unasked == 0);
    for (const auto& [key, finding] : done.findings) {
      table.text +=
          fmt::format("  {}: {} {} times, first in case {}\n", key.first, key.second, finding.count, finding.number);
      table.text += reproduce(property, key.first, finding, ledger, folder);
    }
    table.held = table.held && complaints.empty() && all.counts.failures == 0;
  }
  return table;
}

std::string fuzz_list(const fuzz::Properties& properties) {
  std::string text;
  for (const auto& property : properties) {
    text += fmt::format("{:<11} {} [{} streams]\n", property->name(), property->promise(), property->streams().size());
  }
  return text;
}

}  // namespace selvage::cli
