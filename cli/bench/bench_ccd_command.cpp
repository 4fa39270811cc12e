#include "cli/bench/bench_ccd_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/ccd_bench.h"
#include "cli/answer/result.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/arguments/thread_limit.h"
#include "cli/bench/bench_figures.h"
#include "cli/bench/bench_outputs.h"
#include "cli/bench/plugin_method.h"
#include "cli/command.h"
#include "cli/process/terminal.h"

namespace selvage::cli {
namespace {

struct CcdArguments {
  std::string frame_t0, frame_t1;
  std::vector<std::vector<std::string>> truth;
  int sheet = 160;
  PluginArguments plugin;
  BenchOutputs outputs;
  bench::CcdBenchOptions options;
};

std::string table(const bench::CcdBenchReport& report) {
  std::string text =
      fmt::format("{}: {} vertices, {} faces; candidates {} vf + {} ee in {:.0f} ms; contacts {} vf + {} ee\n",
                  report.motion, report.vertices, report.faces, report.vf_candidates, report.ee_candidates,
                  report.broad_phase_ns * 1e-6, report.vf_contacts, report.ee_contacts);
  if (report.labels > 0) {
    text += fmt::format("{} published verdicts, {} of them contradicted by the exact checker\n", report.labels,
                        report.labels_contradicted);
  }
  const std::string guest = report.guest ? fmt::format("{} {}", bench::kGuestRow, report.guest->name) : "";
  const std::size_t width = std::max<std::size_t>(13, guest.size());
  text += fmt::format("{:<{}} {:>8} {:>7} {:>6} {:>10} {:>10} {:>8} {:>8} {:>8} {:>8} {:>9}  {}\n", "method", width,
                      "alarms", "missed", "false", "beyond gap", "unresolved", "late toi", "mean ns", "vf ns", "ee ns",
                      "/textbook", "toi early: median, p99, max");
  for (const bench::CcdMethodReport& method : report.methods) {
    const std::string late = method.gives_toi ? std::to_string(method.toi.late) : "-";
    text += fmt::format("{:<{}} {:>8} {:>7} {:>6} {:>10} {:>10} {:>8} {:>8.1f} {:>8.1f} {:>8.1f} {:>9.3f}",
                        method.name == bench::kGuestRow ? guest : method.name, width, method.alarms,
                        method.false_negatives, method.false_positives, method.false_positives_beyond_gap,
                        method.unresolved, late, method.ns_mean, method.ns_vf, method.ns_ee, method.ratio);
    if (method.toi_examined > 0) {
      text +=
          fmt::format("  {:.1e}, {:.1e}, {:.1e}", method.toi.early_median, method.toi.early_p99, method.toi.early_max);
    }
    text += '\n';
  }
  if (report.guest) text += words_of(*report.guest) + "\n";
  const bench::CcdMethodReport& kernel = report.methods.front();
  text += fmt::format("the kernel's lanes left {} pairs to single queries: {:.2f} %\n", kernel.searched,
                      100 * static_cast<double>(kernel.searched) /
                          static_cast<double>(std::max<std::int64_t>(1, report.vf_candidates + report.ee_candidates)));
  return text +
         "one thread; processor time of the best whole pass over all candidates; the exact checker says the truth\n";
}

ExitCode bench_ccd(const CcdArguments& arguments) {
  const bool from_files = !arguments.frame_t0.empty();
  if (from_files && arguments.frame_t1.empty()) throw UsageError("a motion needs two frames: add FRAME_T1");
  if (!from_files && !arguments.truth.empty()) throw UsageError("--truth belongs to frames from files: name two");
  std::vector<std::filesystem::path> inputs = {arguments.frame_t0, arguments.frame_t1};
  for (const std::vector<std::string>& files : arguments.truth) inputs.insert(inputs.end(), files.begin(), files.end());
  const bool has_plugin = !arguments.plugin.library.empty();
  if (has_plugin) inputs.emplace_back(arguments.plugin.library);
  require_outputs(inputs, arguments.outputs.files());
  const bench::MeshMotion motion = from_files ? bench::read_mesh_motion(arguments.frame_t0, arguments.frame_t1)
                                              : bench::crumpled_sheet(arguments.sheet);
  std::vector<bench::LabelledPair> labels;
  for (const std::vector<std::string>& files : arguments.truth) {
    const auto read = bench::read_pair_labels(files.at(0), files.at(1), motion.mesh);
    labels.insert(labels.end(), read.begin(), read.end());
  }
  bench::TimedCandidates candidates = [&] {
    const auto limit = ThreadLimit{has_plugin ? 1 : 0}.hold();  // no thread may stand beside a plugin's process
    return bench::time_candidates(motion, arguments.options.tolerance);
  }();
  std::optional<bench::GuestMethod<bench::KindTimes>> guest;
  if (has_plugin) {
    auto measured = measure_plugin(arguments.plugin, motion, candidates.pairs, arguments.options.repeat);
    if (!measured.misbehaviour.empty()) {
      say("selvage: {}\n", measured.misbehaviour);
      return ExitCode::kViolation;
    }
    guest = std::move(measured.method);
  }
  bench::CcdBenchReport report = bench::run_ccd_bench(motion, std::move(candidates), labels, arguments.options, guest);
  report.motion = from_files ? arguments.frame_t0 + " -> " + arguments.frame_t1 : "crumpled sheet";
  print_result(table(report), arguments.outputs.files());
  if (!arguments.outputs.json.empty()) write_report(arguments.outputs.json, bench::to_json(report));
  if (!arguments.outputs.svg.empty()) write_report(arguments.outputs.svg, plot::to_svg(figure_of(report)));
  const auto is_wrong = [](const bench::CcdMethodReport& method) {
    const bool must_be_safe = method.name.starts_with("kernel") || method.name == bench::kGuestRow;
    return must_be_safe && (method.false_negatives > 0 || method.toi.late > 0);
  };
  const bool wrong = std::any_of(report.methods.begin(), report.methods.end(), is_wrong);
  return wrong || report.labels_contradicted > 0 ? ExitCode::kViolation : ExitCode::kClean;
}

}  // namespace

void add_bench_ccd_command(CLI::App& bench, Job& job) {
  CLI::App& ccd =
      add_command(bench, "ccd",
                  "The kernel, the textbook method and the exact checker on all candidate pairs of a motion: of a mesh "
                  "between two files, or of a crumpled sheet; and with --plugin somebody's own kernel. Exit code 1 if "
                  "the kernel or the plugin missed a contact or answered late, if the plugin misbehaves (then nothing "
                  "is measured), or if published verdicts are contradicted.",
                  "selvage bench ccd cloth_ball92.ply cloth_ball93.ply --json out.json");
  const auto arguments = std::make_shared<CcdArguments>();
  ccd.add_option("FRAME_T0", arguments->frame_t0, "Mesh at t = 0 (.obj, .ply)");
  ccd.add_option("FRAME_T1", arguments->frame_t1, "The same mesh at t = 1");
  ccd.add_option("--truth", arguments->truth, "Published pairs and which of them touch (JSON lists); may be repeated")
      ->type_size(2)
      ->allow_extra_args(false)
      ->type_name("BOXES VERDICTS");
  ccd.add_option("--sheet", arguments->sheet, "Vertices along one side of the crumpled sheet")
      ->check(whole_between(2, 2000))
      ->capture_default_str();
  add_plugin(ccd, arguments->plugin);
  add_outputs(ccd, arguments->outputs);
  ccd.add_option("--repeat", arguments->options.repeat, "Timed passes")
      ->check(whole_between(1, 10000))
      ->capture_default_str();
  ccd.add_option("--tolerance", arguments->options.tolerance, "The kernel's tolerance at the end of the step")
      ->check(number_from(0))
      ->capture_default_str();
  ccd.callback([arguments, &job] { job = [arguments] { return bench_ccd(*arguments); }; });
}

}  // namespace selvage::cli
