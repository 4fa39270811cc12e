#include "cli/doctor_command.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hwy/highway.h>
#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "cli/answer/result.h"
#include "cli/arguments/output_check.h"
#include "cli/process/fp_state.h"
#include "cli/process/hostile_fp.h"
#include "cli/process/self_check.h"
#include "cli/process/version.h"
#include "kernel/fp_env.h"

namespace selvage::cli {
namespace {

constexpr const char* kSchema = "selvage.doctor/1";

struct Diagnosis {
  std::vector<std::string> as_found;     ///< defects at the start of the program; not fatal if a guard repairs them
  std::vector<std::string> under_guard;  ///< defects that remain, of this thread and of the workers
  SelfCheck self_check;
  std::vector<std::string> hostile;  ///< environments that were tried
  SelfCheck hostile_check;           ///< over all of them
  std::vector<std::string> simd;     ///< targets this processor has and the program was built for, the best first
  int threads = 0;
  unsigned cores = 0;
  std::string versions;

  bool is_sound() const { return under_guard.empty() && self_check.wrong.empty() && hostile_check.wrong.empty(); }
};

/// Of the worker threads, each under a guard as in the libraries.
unsigned worker_defects() {
  std::atomic<unsigned> defects = 0;
  tbb::parallel_for(0, 1000, [&](int) {
    const FpEnvGuard guard;
    defects |= fp_env_defects();
  });
  return defects;
}

/// The libraries set the environment at their entries: theirs must not matter, and must come back as it was.
SelfCheck check_hostile(const HostileFp& hostile) {
  const HostileScope scope(hostile);
  const unsigned before = fp_env_defects();
  SelfCheck check = run_self_check();
  check.answers += 1;
  if (fp_env_defects() != before) check.wrong.emplace_back("the environment of the caller is not restored");
  if (before == 0) check.wrong.emplace_back("the environment cannot be set, so that nothing was tried");
  return check;
}

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  for (std::int64_t target = 1; target > 0 && target <= supported; target <<= 1) {  // the best has the lowest bit
    if ((supported & target) != 0) names.emplace_back(hwy::TargetName(target));
  }
  return names;
}

Diagnosis examine(unsigned fp_as_found) {
  Diagnosis diagnosis;
  diagnosis.as_found = describe_fp_defects(fp_as_found);
  diagnosis.under_guard = describe_fp_defects(fp_env_defects() | worker_defects());
  diagnosis.self_check = run_self_check();
  for (const HostileFp& hostile : hostile_environments()) {
    diagnosis.hostile.emplace_back(hostile.name);
    const SelfCheck check = check_hostile(hostile);
    diagnosis.hostile_check.answers += check.answers;
    for (const std::string& wrong : check.wrong) {
      diagnosis.hostile_check.wrong.push_back(std::string(hostile.name) + ": " + wrong);
    }
  }
  diagnosis.simd = simd_targets();
  diagnosis.threads = tbb::this_task_arena::max_concurrency();
  diagnosis.cores = std::thread::hardware_concurrency();
  diagnosis.versions = version_text();
  return diagnosis;
}

std::string verdict_of(const SelfCheck& check) {
  if (check.wrong.empty()) return fmt::format("{} answers, all right", check.answers);
  return fmt::format("{} answers, {} WRONG: {}", check.answers, check.wrong.size(), fmt::join(check.wrong, "; "));
}

std::string text_of(const Diagnosis& diagnosis) {
  std::string text = diagnosis.is_sound() ? "sound\n" : "unsound\n";
  const std::string found =
      diagnosis.as_found.empty() ? "sound as found" : fmt::format("as found: {}", fmt::join(diagnosis.as_found, ", "));
  const std::string remaining = diagnosis.under_guard.empty()
                                    ? (diagnosis.as_found.empty() ? "" : "; repaired")
                                    : fmt::format("; NOT REPAIRED: {}", fmt::join(diagnosis.under_guard, ", "));
  text += fmt::format("floating point: {}{}\n", found, remaining);
  text += fmt::format("self-check:     {}\n", verdict_of(diagnosis.self_check));
  text +=
      fmt::format("called where:   {}: {}\n", fmt::join(diagnosis.hostile, "; "), verdict_of(diagnosis.hostile_check));
  text += fmt::format("SIMD:           {}\n", fmt::join(diagnosis.simd, ", "));
  text += fmt::format("threads:        {} of {} cores\n", diagnosis.threads, diagnosis.cores);
  return text + diagnosis.versions + "\n";
}

std::string json_of(const Diagnosis& diagnosis) {
  const auto to_json = [](const SelfCheck& check) {
    return nlohmann::ordered_json{{"answers", check.answers}, {"wrong", check.wrong}};
  };
  nlohmann::ordered_json json;
  json["schema"] = kSchema;
  json["verdict"] = diagnosis.is_sound() ? "sound" : "unsound";
  json["floating_point"] = {{"defects_as_found", diagnosis.as_found}, {"defects_under_guard", diagnosis.under_guard}};
  json["self_check"] = to_json(diagnosis.self_check);
  json["hostile"] = to_json(diagnosis.hostile_check);
  json["hostile"]["environments"] = diagnosis.hostile;
  json["simd"] = diagnosis.simd;
  json["threads"] = diagnosis.threads;
  json["cores"] = diagnosis.cores;
  json["versions"] = diagnosis.versions;
  return json.dump(1) + "\n";
}

ExitCode run(unsigned fp_as_found, const std::string& json) {
  require_outputs({}, {json});
  const Diagnosis diagnosis = examine(fp_as_found);
  if (!json.empty()) write_report(json, json_of(diagnosis));
  print_result(text_of(diagnosis), {json});
  return diagnosis.is_sound() ? ExitCode::kClean : ExitCode::kFpEnvironment;
}

}  // namespace

void add_doctor_command(CLI::App& program, Job& job, unsigned fp_as_found) {
  CLI::App& command = add_command(
      program, "doctor", "Whether this machine and this process compute as the proofs assume", "selvage doctor");
  const auto json = std::make_shared<std::string>();
  command.add_option("--json", *json, "Write the findings as JSON")->type_name("FILE");
  command.callback([json, fp_as_found, &job] { job = [json, fp_as_found] { return run(fp_as_found, *json); }; });
}

}  // namespace selvage::cli
