#include "tests/mutants/class_ranking.h"

#include <algorithm>
#include <map>
#include <sstream>

#include "fuzz/campaign.h"
#include "tests/mutants/child_processes.h"
#include "tests/mutants/planted.h"

namespace selvage::mutants {
namespace {

constexpr std::uint64_t kSeed = 4;

const fuzz::QueryProperty* query_property(const std::string& name) {
  const auto& all = fuzz::query_properties();
  const auto found = std::ranges::find(all, name, &fuzz::QueryProperty::name);
  return found == all.end() ? nullptr : &*found;
}

/// In a process of its own: the share of failing cases for each class, in order.
std::string shares(const Mutant& mutant, const fuzz::QueryProperty& property, long cases) {
  planted = mutant.number;
  std::map<const fuzz::QueryClass*, fuzz::Tally> tallies;
  for (const fuzz::Chunk& chunk : fuzz::make_chunks(0, cases)) {
    tallies[chunk.query_class] +=
        fuzz::run_chunk(property, fuzz::selvage_kernel, kSeed, chunk, [](const fuzz::Failure&) {});
  }
  std::string text;
  for (const fuzz::QueryClass& one : fuzz::query_classes()) {
    const fuzz::Tally& tally = tallies[&one];
    text +=
        std::to_string(static_cast<double>(tally.failures) / static_cast<double>(std::max<long>(tally.cases, 1))) + " ";
  }
  return text;
}

void add(const Mutant& mutant, const std::string& text, std::vector<ClassWorth>& classes) {
  std::istringstream in(text);
  std::vector<double> share(classes.size());
  for (double& s : share) in >> s;
  const double most = *std::ranges::max_element(share);
  const auto killers = std::ranges::count_if(share, [](double s) { return s > 0; });
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (!(share[i] > 0)) continue;
    classes[i].kills.push_back(mutant.name);
    if (share[i] == most) classes[i].leads.push_back(mutant.name);
    if (killers == 1) classes[i].alone.push_back(mutant.name);
  }
}

}  // namespace

std::vector<ClassWorth> rank_classes(const std::vector<Mutant>& mutants, long cases, int jobs) {
  std::vector<ClassWorth> classes;
  for (const fuzz::QueryClass& one : fuzz::query_classes()) classes.push_back({one.name, {}, {}, {}});
  std::vector<const Mutant*> asked;
  std::vector<std::function<std::string()>> work;
  for (const Mutant& mutant : mutants) {
    const fuzz::QueryProperty* property = query_property(mutant.killer);
    if (property == nullptr) continue;
    asked.push_back(&mutant);
    work.emplace_back([&mutant, property, cases] { return shares(mutant, *property, cases); });
  }
  const auto results = run_children(work, jobs, [](std::size_t, const ChildResult&) {});
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (results[i].end == ChildEnd::kDone) add(*asked[i], results[i].text, classes);
  }
  return classes;
}

}  // namespace selvage::mutants
