#include "cli/answer/merge_campaigns.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/answer/fuzz_table.h"
#include "cli/arguments/output_check.h"
#include "fuzz/run/driver.h"
#include "fuzz/run/work_units.h"
#include "io/file/atomic_file.h"

namespace selvage::cli {
namespace {

namespace fs = std::filesystem;

/// A bounded campaign is whole if every work unit that was asked for is done.
void require_all_units(const fuzz::Ledger& ledger, const fuzz::Properties& properties) {
  for (std::size_t p = 0; p < properties.size(); ++p) {
    const auto wanted = fuzz::unit_count(*properties[p], ledger.cases);
    const std::int64_t done = ledger.properties[p].units.size();
    if (wanted && done != *wanted) {
      throw io::Error(io::ErrorKind::kBadInput,
                      fmt::format("merge: {} of {} work units of {} are done; run the shards again with --resume", done,
                                  *wanted, properties[p]->name()));
    }
  }
}

/// What it declares, and what its report needs, is in the library, not in its campaign.
void require_no_plugin(const fuzz::Ledger& ledger, const fs::path& file) {
  if (!ledger.plugin_crc32) return;
  throw io::Error(io::ErrorKind::kBadInput,
                  fmt::format("{}: is a campaign of collision code under --plugin ({}), and those are not joined; "
                              "read the report of each shard, conformance.txt beside it",
                              file.string(), ledger.target));
}

/// Those that the ledger names, as the table describes them.
fuzz::Properties properties_of(const fuzz::Ledger& ledger) {
  fuzz::Properties chosen;
  for (auto& property : fuzz::all_properties()) {
    const auto same = [&](const fuzz::PropertyLedger& one) { return one.name == property->name(); };
    if (std::ranges::any_of(ledger.properties, same)) chosen.push_back(std::move(property));
  }
  const fuzz::Ledger blank = fuzz::make_ledger(chosen);
  const auto same = [](const fuzz::PropertyLedger& a, const fuzz::PropertyLedger& b) {
    return a.name == b.name && a.streams == b.streams && a.counters == b.counters;
  };
  if (!std::ranges::equal(blank.properties, ledger.properties, same)) {
    throw io::Error(io::ErrorKind::kBadInput,
                    "merge: the campaigns are of another version of this program; merge with that one");
  }
  return chosen;
}

}  // namespace

bool are_campaigns(const std::vector<fs::path>& sources) {
  return std::ranges::all_of(sources, [](const fs::path& folder) { return fs::exists(folder / fuzz::kLedgerFile); });
}

ExitCode merge_campaigns(const std::vector<fs::path>& sources, const fs::path& output) {
  std::vector<fs::path> files;
  for (const fs::path& folder : sources) files.push_back(folder / fuzz::kLedgerFile);
  require_separate_outputs(files, {output / fuzz::kLedgerFile});
  std::vector<fuzz::Ledger> parts;
  for (const fs::path& file : files) {
    parts.push_back(fuzz::parse_ledger(io::read_file(file), file.string()));
    require_no_plugin(parts.back(), file);
  }
  const fuzz::Ledger merged = fuzz::merge(parts);
  const fuzz::Properties properties = properties_of(merged);
  require_all_units(merged, properties);
  fs::create_directories(output);
  for (std::size_t p = 0; p < merged.properties.size(); ++p) {
    for (const auto& [key, finding] : merged.properties[p].findings) {
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto& findings = parts[i].properties[p].findings;
        const auto own = findings.find(key);
        if (own == findings.end() || own->second.number != finding.number || finding.file.empty()) continue;
        io::write_atomically(output / finding.file, io::read_file(sources[i] / finding.file));
      }
    }
  }
  io::write_atomically(output / fuzz::kLedgerFile, fuzz::to_json(merged));
  const FuzzTable table = fuzz_table(merged, properties, output.string());
  fmt::print("{}", table.text);
  if (!table.held) return ExitCode::kViolation;
  return table.is_whole ? ExitCode::kClean : ExitCode::kLimit;
}

}  // namespace selvage::cli
