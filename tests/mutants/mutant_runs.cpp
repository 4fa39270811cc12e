#include "tests/mutants/mutant_runs.h"

#include <optional>

#include <oneapi/tbb/global_control.h>

#include "tests/mutants/child_processes.h"
#include "tests/mutants/planted.h"

namespace selvage::mutants {

int planted = 0;

namespace {

/// In a process of its own: the number of cases, 0 for a survivor, then what failed. One thread where it can be: the
/// machine's cores are for other tasks.
std::string work_on(const Task& task) {
  std::optional<oneapi::tbb::global_control> one_thread;
  if (!task.property->is_about_threads) {
    one_thread.emplace(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  }
  planted = task.planted;
  const std::optional<Kill> kill = task.property->falsify(task.seed, task.limit);
  return kill ? std::to_string(kill->cases) + " " + kill->what : "0 ";
}

TaskResult result_of(const Task& task, const ChildResult& child) {
  TaskResult result{task, Ending::kCrashed, {}, child.seconds};
  if (child.end == ChildEnd::kTimeout) result.ending = Ending::kTimeout;
  if (child.end != ChildEnd::kDone) return result;
  std::size_t end = 0;
  result.kill.cases = std::stol(child.text, &end);
  result.kill.what = child.text.substr(end + 1);
  result.ending = result.kill.cases > 0 ? Ending::kKilled : Ending::kSurvived;
  return result;
}

}  // namespace

std::vector<TaskResult> run_tasks(const std::vector<Task>& tasks, int jobs,
                                  const std::function<void(const TaskResult&)>& on_result) {
  std::vector<std::function<std::string()>> work;
  for (const Task& task : tasks) work.emplace_back([&task] { return work_on(task); });
  std::vector<TaskResult> results(tasks.size());
  run_children(work, jobs, [&](std::size_t i, const ChildResult& child) {
    results[i] = result_of(tasks[i], child);
    on_result(results[i]);
  });
  return results;
}

}  // namespace selvage::mutants
