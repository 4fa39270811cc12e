#include "cli/bench/bench_broad_command.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "bench/broad_bench.h"
#include "cli/answer/result.h"
#include "cli/arguments/list_option.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/bench/bench_figures.h"
#include "cli/bench/bench_outputs.h"
#include "cli/command.h"
#include "cli/process/terminal.h"

namespace selvage::cli {
namespace {

struct BroadArguments {
  std::string frame_t0, frame_t1;
  int largest = 100'000;
  std::vector<double> pleat_advances{0.1};
  BenchOutputs outputs;
  bench::BroadBenchOptions options;
};

double ms(double nanoseconds) { return nanoseconds * 1e-6; }

std::string table(const bench::BroadMotionReport& report) {
  std::string text = fmt::format(
      "{}: {} vertices, {} faces; candidates {} vf + {} ee; {:.1f} ns / (#F log2 #F + candidates); "
      "{} features by brute force: {} differences\n",
      report.motion, report.vertices, report.faces, report.vf, report.ee, report.ns_per_work, report.sampled,
      report.differences);
  text += fmt::format("  {:<9} {:>7} {:>9} {:>9} {:>9} {:>9} {:>10} {:>8} {:>8}\n", "method", "threads", "build ms",
                      "refit ms", "query ms", "wall ms", "/default", "missing", "extra");
  for (const bench::BroadMethodReport& method : report.methods) {
    const auto is_reference = [&](const auto& m) { return m.thread_count == method.thread_count; };
    const auto reference = std::find_if(report.methods.begin(), report.methods.end(), is_reference);
    text += fmt::format("  {:<9} {:>7} {:>9.1f} {:>9} {:>9.1f} {:>9.1f} {:>10.2f} {:>8} {:>8}\n", method.name,
                        method.thread_count, ms(method.build.cpu),
                        method.refit.cpu > 0 ? fmt::format("{:.1f}", ms(method.refit.cpu)) : "-", ms(method.query.cpu),
                        ms(method.query.wall), method.query.wall / reference->query.wall, method.missing, method.extra);
  }
  for (const bench::BroadIncrementalReport& row : report.incremental) {
    text += fmt::format("  {:>8} of the vertices moved ({}): {:>9} candidates, refit {:.1f} ms, query {:.2f} ms\n",
                        row.active_vertices, row.spread, row.candidates, ms(row.refit.cpu), ms(row.query.cpu));
  }
  return text;
}

/// Sheets from 10 thousand faces up, about three times as many each, the last with about `largest`.
std::vector<int> sheet_sides(int largest) {
  const auto side = [](double faces) { return static_cast<int>(std::lround(std::sqrt(faces / 2))) + 1; };
  std::vector<int> sides;
  for (double faces = 10'000; faces < 0.7 * largest; faces *= std::sqrt(10.0)) sides.push_back(side(faces));
  sides.push_back(side(largest));
  return sides;
}

ExitCode bench_broad(const BroadArguments& arguments) {
  require_outputs({arguments.frame_t0, arguments.frame_t1}, arguments.outputs.files());
  const auto rivals = bench::load_rivals(bench::rivals_beside_program());
  for (const bench::LoadedRival& rival : rivals) {
    if (!rival.create) say("selvage: without {}: {}\n", rival.name, rival.absent);
  }
  std::vector<bench::BroadMotionReport> reports;
  const auto run = [&](const std::string& name, const bench::MeshMotion& motion) {
    reports.push_back(bench::run_broad_bench(motion, rivals, arguments.options));
    reports.back().motion = name;
    print_result(table(reports.back()), arguments.outputs.files());
  };
  if (!arguments.frame_t0.empty()) {
    if (arguments.frame_t1.empty()) throw UsageError("a motion needs two frames: add FRAME_T1");
    run(arguments.frame_t0 + " -> " + arguments.frame_t1,
        bench::read_mesh_motion(arguments.frame_t0, arguments.frame_t1));
  } else {
    for (const double advance : arguments.pleat_advances) {
      for (const int side : sheet_sides(arguments.largest)) {
        run(fmt::format("sheet pleated by {}", advance), bench::crumpled_sheet(side, advance));
      }
    }
  }
  print_result(fmt::format("processor time of all threads, and wall time of the query; best of {} passes; reach 0\n",
                           arguments.options.repeat),
               arguments.outputs.files());
  if (!arguments.outputs.json.empty()) write_report(arguments.outputs.json, bench::to_json(reports, rivals));
  if (!arguments.outputs.svg.empty()) write_report(arguments.outputs.svg, plot::to_svg(figure_of(reports)));
  const auto wrong = [](const bench::BroadMotionReport& report) { return bench::is_wrong(report); };
  return std::ranges::any_of(reports, wrong) ? ExitCode::kViolation : ExitCode::kClean;
}

}  // namespace

void add_bench_broad_command(CLI::App& bench, Job& job) {
  CLI::App& broad =
      add_command(bench, "broad",
                  "The broad phase, by position and from connectivity, against CGAL's box_intersection_d and Embree's "
                  "rtcCollide: on a mesh between two files, or on crumpled sheets of growing size. Exit code 1 if the "
                  "kernel's trees or brute force on a sample differ.",
                  "selvage bench broad cloth_ball92.ply cloth_ball93.ply --json out.json");
  const auto arguments = std::make_shared<BroadArguments>();
  broad.add_option("FRAME_T0", arguments->frame_t0, "Mesh at t = 0 (.obj, .ply)");
  broad.add_option("FRAME_T1", arguments->frame_t1, "The same mesh at t = 1");
  broad.add_option("--largest", arguments->largest, "Faces of the largest sheet")
      ->check(whole_between(10, 10'000'000))
      ->capture_default_str();
  add_list(broad, "--pleats", arguments->pleat_advances,
           "How far an edge takes a sheet along, in edges: 0.1 is 10 layers")
      ->check(number_between(0.01, 1))
      ->capture_default_str();
  add_list(broad, "--threads", arguments->options.thread_counts, "Numbers of threads")
      ->check(whole_between(1, 1024))
      ->capture_default_str();
  broad.add_option("--sample", arguments->options.sampled, "Vertices and edges compared with brute force")
      ->check(whole_between(1, 1'000'000))
      ->capture_default_str();
  add_outputs(broad, arguments->outputs);
  broad.add_option("--repeat", arguments->options.repeat, "Timed passes")
      ->check(whole_between(1, 10000))
      ->capture_default_str();
  broad.callback([arguments, &job] { job = [arguments] { return bench_broad(*arguments); }; });
}

}  // namespace selvage::cli
