// selvage_mutants LISTS: runs mutants of the lists under their properties and three seeds, the base first. Exit code 0
// if all are killed within their cases, or proven equivalent and not killed, and every class of queries has its worth
// (class_ranking.h, with --classes); else 1.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <map>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "io/file/atomic_file.h"
#include "tests/mutants/mutant_report.h"

namespace selvage::mutants {
namespace {

struct Arguments {
  std::string lists, json, markdown;
  std::vector<std::string> only, sources, killers;
  int jobs = 2;
  std::uint64_t seeds = 3;
  long class_cases = 0;
};

void print(const TaskResult& result) {
  const char* endings[] = {"killed", "survives", "CRASHED", "TIMEOUT"};
  std::printf("%-5s seed %llu  %-9s %-16s", result.task.name.c_str(), static_cast<unsigned long long>(result.task.seed),
              endings[static_cast<int>(result.ending)], std::string(result.task.property->name).c_str());
  if (result.ending == Ending::kKilled) std::printf(" case %ld: %s", result.kill.cases, result.kill.what.c_str());
  std::printf("  %.2f s\n", result.seconds);
  std::fflush(stdout);
}

std::vector<Mutant> chosen_mutants(const Arguments& arguments) {
  std::vector<Mutant> mutants = read_lists(arguments.lists);
  const auto is_among = [](const std::vector<std::string>& names, const std::string& name) {
    return names.empty() || std::ranges::count(names, name) > 0;
  };
  std::erase_if(mutants, [&](const Mutant& m) {
    const auto is_here = [&](const Edit& edit) { return is_among(arguments.sources, edit.file); };
    return !is_among(arguments.only, m.name) || !is_among(arguments.killers, m.killer) ||
           !std::ranges::all_of(m.edits, is_here);
  });
  if (mutants.empty()) throw std::runtime_error("there is no such mutant");
  return mutants;
}

/// Every property that kills, on unchanged code, for as many cases as any of its mutants may take.
std::vector<Task> base_tasks(const std::vector<Mutant>& mutants, std::uint64_t seeds) {
  std::map<std::string, long> limits;
  for (const Mutant& mutant : mutants) {
    limits[mutant.killer] = std::max(limits[mutant.killer], mutant.within);
  }
  std::vector<Task> tasks;
  for (const auto& [name, limit] : limits) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed)
      tasks.push_back({"base", 0, &property_named(name), seed, limit});
  }
  return tasks;
}

std::vector<Task> mutant_tasks(const std::vector<Mutant>& mutants, std::uint64_t seeds) {
  std::vector<Task> tasks;
  for (const Mutant& mutant : mutants) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      tasks.push_back({mutant.name, mutant.number, &property_named(mutant.killer), seed, mutant.within});
    }
  }
  return tasks;
}

int run(const Arguments& arguments) {
  const std::vector<Mutant> mutants = chosen_mutants(arguments);
  const std::vector<TaskResult> base = run_tasks(base_tasks(mutants, arguments.seeds), arguments.jobs, print);
  for (const TaskResult& result : base) {
    if (result.ending != Ending::kSurvived) {
      std::fprintf(stderr, "selvage_mutants: the base fails %s\n", std::string(result.task.property->name).c_str());
      return 1;
    }
  }
  const std::vector<TaskResult> results = run_tasks(mutant_tasks(mutants, arguments.seeds), arguments.jobs, print);
  std::vector<MutantOutcome> outcomes;
  for (std::size_t i = 0; i < mutants.size(); ++i) {
    const auto first = results.begin() + static_cast<std::ptrdiff_t>(i * arguments.seeds);
    outcomes.push_back({mutants[i], {first, first + static_cast<std::ptrdiff_t>(arguments.seeds)}});
  }
  std::vector<ClassWorth> classes;
  if (arguments.class_cases > 0) classes = rank_classes(mutants, arguments.class_cases, arguments.jobs);
  const Report report{std::move(outcomes), base, std::move(classes)};
  if (!arguments.json.empty()) io::write_atomically(arguments.json, json_report(report));
  if (!arguments.markdown.empty()) io::write_atomically(arguments.markdown, markdown_report(report));
  const auto open = std::ranges::count_if(report.outcomes, [](const MutantOutcome& o) { return !o.is_settled(); });
  std::printf("%zu mutants, %td not settled\n", report.outcomes.size(), open);
  bool all_earn = true;
  for (const ClassWorth& worth : report.classes) {
    if (worth.earns_its_place()) continue;
    all_earn = false;
    std::printf("class %s is the first to kill nothing and holds no record: find its defect, or drop it\n",
                worth.name.c_str());
  }
  return open == 0 && all_earn ? 0 : 1;
}

}  // namespace
}  // namespace selvage::mutants

int main(int argc, char** argv) {
  selvage::mutants::Arguments arguments;
  CLI::App program("Runs planted defects under the properties that must find them");
  program.add_option("lists", arguments.lists, "folder of *.mutants")->required();
  program.add_option("--only", arguments.only, "names of mutants")->delimiter(',');
  program.add_option("--sources", arguments.sources, "only mutants of these sources")->delimiter(',');
  program.add_option("--killers", arguments.killers, "only mutants that these properties kill")->delimiter(',');
  program.add_option("--seeds", arguments.seeds, "how many: 1, 2, ...")->check(CLI::PositiveNumber);
  program.add_option("--json", arguments.json, "report for programs");
  program.add_option("--markdown", arguments.markdown, "report for people");
  program.add_option("--classes", arguments.class_cases, "cases a class and mutant, for the ranking of generators");
  program.add_option("--jobs", arguments.jobs, "processes at a time")->check(CLI::PositiveNumber);
  CLI11_PARSE(program, argc, argv);
  try {
    return selvage::mutants::run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "selvage_mutants: %s\n", error.what());
    return 2;
  }
}
