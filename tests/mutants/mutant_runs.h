// Every mutant under three seeds, each in a process of its own: what crashes or hangs there says so and is no kill.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/mutants/mutant_list.h"
#include "tests/mutants/properties.h"

namespace selvage::mutants {

/// Of `property`, with one mutant or none.
struct Task {
  std::string name;  ///< for people
  int planted = 0;
  const Property* property = nullptr;
  std::uint64_t seed = 0;
  long limit = 0;
};

enum class Ending : std::uint8_t { kKilled, kSurvived, kCrashed, kTimeout };

struct TaskResult {
  Task task;
  Ending ending = Ending::kSurvived;
  Kill kill;           ///< if killed
  double seconds = 0;  ///< processor time
};

/// In the order of `tasks`, `jobs` at a time; `on_result` as they end. No thread may have been started before.
[[nodiscard]] std::vector<TaskResult> run_tasks(const std::vector<Task>& tasks, int jobs,
                                                const std::function<void(const TaskResult&)>& on_result);

}  // namespace selvage::mutants
