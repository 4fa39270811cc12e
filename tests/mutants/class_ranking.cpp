#include "tests/mutants/class_ranking.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "fuzz/campaign/query_campaign.h"
#include "fuzz/run/records.h"
#include "tests/fuzz/query_cases.h"
#include "tests/mutants/child_processes.h"
#include "tests/mutants/planted.h"

namespace selvage::mutants {
namespace {

constexpr std::uint64_t kSeed = 4;
/// More cases for the records, which are searched for once.
constexpr long kRecordShare = 3;

const fuzz::QueryProperty* query_property(const std::string& name) {
  const auto& all = fuzz::query_properties();
  const auto found = std::ranges::find(all, name, &fuzz::QueryProperty::name);
  return found == all.end() ? nullptr : &*found;
}

/// What `count` cases of a stream come to, fewer of a class that is diluted.
fuzz::Counts counts_of(fuzz::Property& campaign, const fuzz::Stream& stream, long count) {
  fuzz::Counts counts;
  for (std::int64_t number = 0; number < fuzz::diluted(stream, count); ++number) {
    counts += campaign.run(stream, fuzz::source_of_case(kSeed, stream, number)).counts;
  }
  return counts;
}

/// In a process of its own: cases and failures of each stream, in order.
std::string count_failures(const Mutant& mutant, const fuzz::QueryProperty& property, long cases) {
  planted = mutant.number;
  const auto campaign = fuzz::make_query_campaign(property);
  std::string text;
  for (const fuzz::Stream& stream : campaign->streams()) {
    const fuzz::Counts counts = counts_of(*campaign, stream, cases);
    text += std::to_string(counts.cases) + " " + std::to_string(counts.failures) + " ";
  }
  return text;
}

/// In a process of its own: the records of unchanged code, each "CLASS MEASURE KIND" in a line.
std::string find_records(long cases) {
  const auto campaign = fuzz::make_query_campaign(fuzz::query_properties().front());
  fuzz::PropertyLedger ledger{campaign->name(), {}, {}, campaign->counters(), {}, {}};
  for (const fuzz::Stream& stream : campaign->streams()) {
    ledger.streams.push_back(stream.name);
    ledger.rows.push_back(counts_of(*campaign, stream, cases));
  }
  std::string text;
  for (const fuzz::SharpnessRecord& record : fuzz::sharpness_records(ledger)) {
    for (const std::string& holder : record.classes) {
      text += holder + " " + record.measure + " " + record.kind + "\n";
    }
  }
  return text;
}

/// Of one mutant, by class.
struct Shares {
  std::vector<double> of_kind[3];  ///< of the queries of one kind
  std::vector<double> of_unit;     ///< failures in a work unit
  std::vector<bool> kills;
};

Shares shares_of(const std::string& text) {
  const auto& classes = fuzz::query_classes();
  Shares shares;
  for (auto& of_kind : shares.of_kind) of_kind.resize(classes.size());
  shares.of_unit.resize(classes.size());
  shares.kills.resize(classes.size());
  std::istringstream in(text);
  for (const fuzz::Stream& stream : fuzz::query_streams(fuzz::kPairKinds, 1)) {
    double asked = 0, failures = 0;
    in >> asked >> failures;
    const auto [query_class, kind] = fuzz::query_stream(stream);
    const auto i = static_cast<std::size_t>(query_class - classes.data());
    shares.of_kind[static_cast<std::size_t>(kind)][i] = failures / asked;
    shares.of_unit[i] += failures / asked * static_cast<double>(query_class->per_unit);
    if (failures > 0) shares.kills[i] = true;
  }
  return shares;
}

/// Calls body(i) for each class that reaches the largest value, if that is above zero.
template <typename Body>
void for_each_first(const std::vector<double>& values, const Body& body) {
  const double most = *std::ranges::max_element(values);
  for (std::size_t i = 0; i < values.size() && most > 0; ++i) {
    if (values[i] == most) body(i);
  }
}

void add(const Mutant& mutant, const Shares& shares, std::vector<ClassWorth>& classes) {
  for (const PairKind kind : fuzz::kPairKinds) {
    const std::string name = mutant.name + " " + std::string(fuzz::name_of(kind));
    for_each_first(shares.of_kind[static_cast<std::size_t>(kind)],
                   [&](std::size_t i) { classes[i].first.push_back(name); });
  }
  for_each_first(shares.of_unit, [&](std::size_t i) { classes[i].first_in_campaign.push_back(mutant.name); });
  const auto killers = std::ranges::count(shares.kills, true);
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (!shares.kills[i]) continue;
    classes[i].kills.push_back(mutant.name);
    if (killers == 1) classes[i].alone.push_back(mutant.name);
  }
}

void add_records(const std::string& text, std::vector<ClassWorth>& classes) {
  std::istringstream in(text);
  for (std::string holder, measure, kind; in >> holder >> measure >> kind;) {
    std::ranges::find(classes, holder, &ClassWorth::name)->records.push_back(measure + " " + kind);
  }
}

}  // namespace

std::vector<ClassWorth> rank_classes(const std::vector<Mutant>& mutants, long cases, int jobs) {
  std::vector<ClassWorth> classes;
  for (const fuzz::QueryClass& one : fuzz::query_classes()) classes.push_back({one.name, {}, {}, {}, {}, {}});
  std::vector<const Mutant*> asked;
  std::vector<std::function<std::string()>> work{[cases] { return find_records(kRecordShare * cases); }};
  for (const Mutant& mutant : mutants) {
    const fuzz::QueryProperty* property = query_property(mutant.killer);
    if (property == nullptr) continue;
    asked.push_back(&mutant);
    work.emplace_back([&mutant, property, cases] { return count_failures(mutant, *property, cases); });
  }
  const auto results = run_children(work, jobs, [](std::size_t, const ChildResult&) {});
  if (results[0].end != ChildEnd::kDone) throw std::runtime_error("the search for records did not come to its end");
  add_records(results[0].text, classes);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const ChildResult& result = results[i + 1];
    if (result.end == ChildEnd::kDone) {
      add(*asked[i], shares_of(result.text), classes);
    } else {
      std::fprintf(stderr, "%s crashes or hangs: no class is ranked by it\n", asked[i]->name.c_str());
    }
  }
  return classes;
}

}  // namespace selvage::mutants
