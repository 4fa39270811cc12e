#include "tests/mutants/mutant_report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace selvage::mutants {
namespace {

const char* name_of(Ending ending) {
  switch (ending) {
    case Ending::kKilled:
      return "killed";
    case Ending::kSurvived:
      return "survived";
    case Ending::kCrashed:
      return "crashed";
    case Ending::kTimeout:
      break;
  }
  return "timeout";
}

nlohmann::ordered_json to_json(const TaskResult& run) {
  nlohmann::ordered_json json = {{"property", run.task.property->name},
                                 {"seed", run.task.seed},
                                 {"limit", run.task.limit},
                                 {"ending", name_of(run.ending)},
                                 {"seconds", run.seconds}};
  if (run.ending == Ending::kKilled) json.update({{"cases", run.kill.cases}, {"what", run.kill.what}});
  return json;
}

long most_cases(const MutantOutcome& outcome) {
  long most = 0;
  for (const TaskResult& run : outcome.runs) most = std::max(most, run.kill.cases);
  return most;
}

double seconds_of(const std::vector<TaskResult>& runs) {
  double sum = 0;
  for (const TaskResult& run : runs) sum += run.seconds;
  return sum;
}

std::string seconds_text(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", seconds);
  return text;
}

std::string mutant_table(const std::vector<MutantOutcome>& outcomes) {
  std::string text =
      "| mutant | defect | breaks | killer | cases, most of three seeds | allowed | seconds, sum |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const MutantOutcome& outcome : outcomes) {
    const Mutant& mutant = outcome.mutant;
    text += "| " + mutant.name + " | " + mutant.defect + " | " + mutant.promise + " | ";
    if (!outcome.is_settled()) {
      text += "**not settled** | | |";
    } else if (!mutant.equivalent.empty()) {
      text += "none: equivalent | | |";
    } else {
      text += mutant.killer + ": " + outcome.runs.front().kill.what + " | " + std::to_string(most_cases(outcome)) +
              " | " + std::to_string(mutant.within) + " |";
    }
    text += " " + seconds_text(seconds_of(outcome.runs)) + " |\n";
  }
  for (const MutantOutcome& outcome : outcomes) {
    if (!outcome.mutant.equivalent.empty())
      text += "\n" + outcome.mutant.name + ": " + outcome.mutant.equivalent + "\n";
  }
  return text;
}

std::string base_table(const std::vector<TaskResult>& base) {
  std::string text = "| property | claim | cases without a defect, each of three seeds | seconds, sum |\n";
  text += "| --- | --- | --- | --- |\n";
  for (std::size_t i = 0; i < base.size();) {
    const Task& task = base[i].task;
    double seconds = 0;
    for (; i < base.size() && base[i].task.property == task.property; ++i) seconds += base[i].seconds;
    text += "| " + std::string(task.property->name) + " | " + std::string(task.property->claim) + " | " +
            std::to_string(task.limit) + " | " + seconds_text(seconds) + " |\n";
  }
  return text;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string class_table(const std::vector<ClassWorth>& classes) {
  if (classes.empty()) return "";
  std::string text =
      "| class | kills | first in cases | first in a campaign | records |\n| --- | --- | --- | --- | --- |\n";
  for (const ClassWorth& worth : classes) {
    text += "| " + worth.name + " | " + std::to_string(worth.kills.size()) + " | " + joined(worth.first) + " | " +
            joined(worth.first_in_campaign) + " | " + joined(worth.records) + " |\n";
  }
  return text;
}

}  // namespace

bool MutantOutcome::is_settled() const {
  const Ending wanted = mutant.equivalent.empty() ? Ending::kKilled : Ending::kSurvived;
  return std::ranges::all_of(runs, [&](const TaskResult& run) { return run.ending == wanted; });
}

std::string json_report(const Report& report) {
  nlohmann::ordered_json json = {{"schema", "selvage.mutants/1"}};
  for (const TaskResult& run : report.base) json["base"].push_back(to_json(run));
  for (const MutantOutcome& outcome : report.outcomes) {
    const Mutant& mutant = outcome.mutant;
    nlohmann::ordered_json entry = {{"name", mutant.name}, {"defect", mutant.defect}, {"breaks", mutant.promise}};
    if (!mutant.equivalent.empty()) entry["equivalent"] = mutant.equivalent;
    entry["settled"] = outcome.is_settled();
    for (const TaskResult& run : outcome.runs) entry["runs"].push_back(to_json(run));
    json["mutants"].push_back(std::move(entry));
  }
  for (const ClassWorth& worth : report.classes) {
    json["classes"].push_back({{"name", worth.name},
                               {"kills", worth.kills},
                               {"first", worth.first},
                               {"first_in_campaign", worth.first_in_campaign},
                               {"alone", worth.alone},
                               {"records", worth.records}});
  }
  return json.dump(2) + "\n";
}

std::string markdown_report(const Report& report) {
  return mutant_table(report.outcomes) + "\n" + base_table(report.base) + "\n" + class_table(report.classes);
}

}  // namespace selvage::mutants
