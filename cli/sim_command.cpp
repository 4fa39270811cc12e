#include "cli/sim_command.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>

#include <fmt/format.h>

#include "cli/answer/enclosed_cloth.h"
#include "cli/answer/part_name.h"
#include "cli/arguments/choice.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/arguments/thread_limit.h"
#include "cli/process/interrupt.h"
#include "cli/process/terminal.h"
#include "cli/start/start_check.h"
#include "io/file/text.h"
#include "kernel/version.h"
#include "sim/base/points.h"
#include "sim/description.h"
#include "sim/record/recorder.h"
#include "sim/scene/scene_reader.h"
#include "sim/step.h"
#include "verify/check.h"

namespace selvage::cli {
namespace {

struct SimArguments {
  std::filesystem::path scene, output;
  std::optional<std::int64_t> frames;
  ThreadLimit threads;
  std::optional<io::SequenceKind> record;
  sim::Quality quality = sim::Quality::kDraft;
  bool resume = false, strict = false, repair = false;
};

const char* name_of_pair(PairKind kind) {
  switch (kind) {
    case PairKind::kVf:
      return "vertex-face";
    case PairKind::kEe:
      return "edge-edge";
    case PairKind::kSelf:
      break;
  }
  return "vertex and opposite edge of a face";
}

void print_witness(const sim::Simulation& simulation, const sim::CollisionStepReport& report) {
  say("stopped at {:.6f} s: no safe position of the cloth was found between what scripts move",
      simulation.clock().time_s());
  std::string_view movers = "bodies";
  if (report.witness) {
    const sim::World& world = simulation.world();
    const Collision& pair = *report.witness;
    std::string parts;
    const auto vertices = pair_vertices(world.mesh, pair.kind, pair.first, pair.second);
    const bool is_self = pair.kind == PairKind::kSelf;  // of three vertices, the first of them twice
    bool has_body = false, has_pin = false;
    for (const VertexId vertex : std::span(vertices).first(is_self ? 3 : 4)) {
      const std::string pin = pin_of_vertex(world, vertex, simulation.clock().time_s());
      has_body = has_body || vertex >= world.cloth_vertex_count;
      has_pin = has_pin || !pin.empty();
      parts += fmt::format("{}{} ({})", parts.empty() ? "" : ", ", vertex,
                           pin.empty() ? part_of_vertex(world, vertex) : pin);
    }
    if (has_pin) movers = has_body ? "bodies and pins" : "pins";
    say("; witness: {} at vertices {}", name_of_pair(pair.kind), parts);
  }
  std::set<std::int32_t> named;
  for (const sim::Blockage& blockage : report.blockages) {
    if (!named.insert(blockage.body).second) continue;
    const sim::Collider& body = simulation.world().colliders[static_cast<std::size_t>(blockage.body)];
    const Vec3& at = blockage.at_m;
    say("; {} cannot go on at ({:.4g}, {:.4g}, {:.4g})", part_of_vertex(simulation.world(), body.vertices().front()),
        at.x(), at.y(), at.z());
  }
  say("\nmove the {} apart, or set squeeze = \"yield\" to let them wait\n", movers);
}

void print_phases(const sim::RunTotals& totals) {
  const auto frames = static_cast<double>(std::max<std::int64_t>(totals.frames, 1));
  fmt::print("{:<24}{:>10}{:>10}{:>18}{:>18}\n", "phase", "wall s", "CPU s", "wall ms a frame", "CPU ms a frame");
  const auto print = [&](const char* name, const sim::PhaseTime& time) {
    fmt::print("{:<24}{:>10.2f}{:>10.2f}{:>18.1f}{:>18.1f}\n", name, time.wall_s, time.cpu_s,
               1e3 * time.wall_s / frames, 1e3 * time.cpu_s / frames);
  };
  print("dynamics", totals.phases.dynamics);
  print("collision step", totals.phases.collision);
  print("  proximities", totals.phases.within.proximity);
  print("  repulsions, friction", totals.phases.within.repulsion);
  print("  first search", totals.phases.within.search);
  print("  response", totals.phases.within.response);
  print("final velocity", totals.phases.velocity);
  print("recording", totals.recording);
  print("all", totals.all());
}

void print_strain(const sim::RunTotals& totals, const sim::World& world) {
  fmt::print("largest strain {:.3g}", totals.largest_strain);
  if (totals.largest_strain > 0) {
    const auto from = static_cast<VertexId>(totals.largest_strain_from);
    fmt::print(" at {:.4g} s, between vertices {} and {} ({})", totals.largest_strain_at_s, from,
               totals.largest_strain_to, part_of_vertex(world, from));
  }
  fmt::print("\n");
}

void print_totals(const sim::RunTotals& totals, const sim::World& world) {
  fmt::print("{} frames, {} steps ({} tried with a longer step first)\n", totals.frames, totals.steps, totals.halvings);
  fmt::print("repulsions {}, frictions {}\n", totals.repulsions, totals.frictions);
  print_strain(totals, world);
  fmt::print("steps with collisions {}, impulse rounds {}, zone rounds {} (largest zone {} vertices)\n",
             totals.steps_with_collisions, totals.impulse_rounds, totals.zone_rounds, totals.largest_zone_vertices);
  fmt::print("fail-safe vertices {}, pairs below tolerance {}, waiting bodies {}, vertices cut back {}\n",
             totals.fail_safe_vertices, totals.pairs_below_tolerance, totals.waiting_bodies, totals.cut_candidates);
  if (totals.dynamics_solves > 0) {
    fmt::print("implicit solves {}, Newton rounds {}, iterations {}, largest residual {:.2g} m, not converged {}\n",
               totals.dynamics_solves, totals.newton_rounds, totals.cg_iterations, totals.largest_residual_m,
               totals.unconverged_solves);
  }
  if (totals.bent_steps > 0) {
    print_notes(
        {fmt::format("{} steps were too long for a body that turns or turns back within them, and may have passed "
                     "cloth beside its way; every step is safe, but lower min_step_s, or slow the body down",
                     totals.bent_steps)});
  }
  if (totals.unconverged_solves > 0) {
    print_notes(
        {fmt::format("{} of {} implicit solves did not converge: cloth ended up to {:.2g} m from where its forces "
                     "put it; every step is safe, but try a lower max_step_s, or solver = \"explicit\"",
                     totals.unconverged_solves, totals.dynamics_solves, totals.largest_residual_m)});
  }
  print_phases(totals);
}

void print_waits(const sim::BodyWaits& waits, const sim::World& world) {
  for (const sim::BodyWait& wait : waits) {
    fmt::print("\"{}\" waited in {} steps from {:.4g} to {:.4g} s, up to {:.3g} m behind its script\n",
               io::printable(world.colliders[static_cast<std::size_t>(wait.collider)].name()), wait.steps, wait.begin_s,
               wait.end_s, wait.largest_lag_m);
  }
}

sim::RunEnd run(sim::Simulation& simulation, sim::Recorder& recorder) {
  const std::int64_t frame_count = simulation.scene().time.frame_count;
  ProgressBar bar("simulating");
  while (simulation.clock().frame() < frame_count) {
    bar.update(static_cast<std::size_t>(simulation.clock().frame()), static_cast<std::size_t>(frame_count));
    if (interrupted()) return sim::RunEnd::kInterrupted;
    const sim::StepResult step = simulation.step();
    if (step.report.status == sim::StepStatus::kInvalidInput) {
      const bool is_explicit = simulation.scene().solver == sim::Solver::kExplicit;
      throw io::Error(
          io::ErrorKind::kBadInput,
          fmt::format("{}: at {:.6f} s {}; {}", simulation.scene().file.string(), simulation.clock().time_s(),
                      describe(step.report.input_error), is_explicit ? "lower dynamics_step_s" : "lower min_step_s"));
    }
    if (step.report.status == sim::StepStatus::kStopped) {
      print_witness(simulation, step.report);
      return sim::RunEnd::kStopped;
    }
    recorder.record(step);
  }
  return sim::RunEnd::kComplete;
}

/// `has_shortfalls`: there are some, and --strict asks for none.
ExitCode exit_code_of(sim::RunEnd end, bool has_shortfalls) {
  if (end == sim::RunEnd::kInterrupted) return ExitCode::kInterrupted;
  return end == sim::RunEnd::kStopped || has_shortfalls ? ExitCode::kViolation : ExitCode::kClean;
}

/// Of a run that an exception ends: run.json says so as well as stderr does.
void note_failure(sim::Recorder& recorder, const std::exception_ptr& exception) {
  const Failure failure = failure_of(exception);
  try {
    recorder.finish({sim::RunEnd::kFailed, static_cast<int>(failure.code), failure.message});
  } catch (const io::Error&) {  // a disk without room for that either: stderr has it
  }
}

/// Of mesh files, and of cloth inside bodies.
std::vector<std::string> notes_on_start(const sim::Simulation& simulation) {
  const sim::World& world = simulation.world();
  std::vector<std::string> notes = world.remarks;
  for (const auto& [cloth, body] : find_enclosed(world.mesh, world.groups, sim::points_of(simulation.x()))) {
    notes.push_back(fmt::format(
        "{} starts inside the closed body {} without meeting it, which is taken as intended: it will stay inside; move "
        "it out if it was to be outside",
        cloth, body));
  }
  return notes;
}

ExitCode simulate(const SimArguments& arguments) {
  catch_interrupts();
  const auto limit = arguments.threads.hold();
  require_folder_name(arguments.output);
  sim::Scene scene = sim::read_scene(arguments.scene, arguments.quality);
  if (arguments.frames) scene.time.frame_count = *arguments.frames;
  sim::Simulation simulation(scene);
  // A run that goes on begins with the state of its checkpoint, which certified steps led to; or that is refused.
  const bool goes_on = arguments.resume && std::filesystem::exists(arguments.output / sim::kCheckpointFile);
  sim::StartRepair repair;
  try {
    if (!goes_on) repair = require_clean_start(simulation, arguments.repair);
    if (interrupted()) throw verify::Stopped();  // while springs relaxed
  } catch (const verify::Stopped&) {
    say("selvage: interrupted while the start was checked; nothing was written\n");
    return ExitCode::kInterrupted;
  }
  say("{}", sim::describe(simulation.scene(), simulation.world()));
  if (!goes_on) print_notes(notes_on_start(simulation));
  sim::Recorder recorder(arguments.output, simulation, arguments.record, arguments.resume, "selvage " SELVAGE_VERSION,
                         repair);
  if (recorder.resumed()) say("resumed    at {:.6f} s\n", simulation.clock().time_s());
  if (const std::int64_t there = simulation.clock().frame(); there > scene.time.frame_count) {
    say("note       it was simulated to frame {} already; --frames {} takes nothing away\n", there,
        scene.time.frame_count);
  }
  sim::RunEnd end{};
  ExitCode code{};
  try {
    recorder.begin();
    end = run(simulation, recorder);
    code = exit_code_of(end, arguments.strict && !recorder.totals().shortfalls().empty());
    recorder.finish({end, static_cast<int>(code)});
  } catch (const std::exception&) {
    note_failure(recorder, std::current_exception());
    throw;
  }
  if (end == sim::RunEnd::kInterrupted) say("selvage: interrupted; go on with --resume\n");
  print_totals(recorder.totals(), simulation.world());
  print_waits(recorder.waits(), simulation.world());
  if (end == sim::RunEnd::kComplete && code == ExitCode::kViolation) {
    say("selvage: --strict: {}\n", recorder.totals().shortfalls());
  }
  return code;
}

}  // namespace

void add_sim_command(CLI::App& program, Job& job) {
  CLI::App& command = add_command(program, "sim", "Simulate a scene; every step is certified free of intersections",
                                  "selvage sim sim/scenes/demo.toml -o demo/curtain --record steps");
  const auto arguments = std::make_shared<SimArguments>();
  command.add_option("scene", arguments->scene, "The scene file (docs/scenes.md)")->required();
  command.add_option("-o,--output", arguments->output, "The sequence folder to write")->required();
  command.add_option("--frames", arguments->frames, "Frames to simulate, instead of what the scene says")
      ->check(whole_between(1, sim::kMaxFrames));
  add_threads(command, arguments->threads);
  add_choice(command, "--record", arguments->record,
             {{"frames", io::SequenceKind::kFrames}, {"steps", io::SequenceKind::kSteps}},
             "frames (default; of a run that is resumed, as it was started), or steps: all that was certified");
  add_choice(command, "--quality", arguments->quality, {{"draft", sim::Quality::kDraft}, {"full", sim::Quality::kFull}},
             "draft (default) or full, where the scene distinguishes");
  command.add_flag("--resume", arguments->resume, "Go on from the checkpoint in the folder, with the same bits");
  command.add_flag(
      "--repair", arguments->repair,
      "Move cloth that starts intersecting until it does not, and say how far; springs keep their rest lengths");
  command.add_flag(
      "--strict", arguments->strict,
      "Exit code 1 also where the fail-safe was needed, the tolerance was missed, a body waited, cloth was cut back or "
      "left torn by --repair, a body turned too far in a step, or an implicit solve did not converge");
  command.callback([arguments, &job] { job = [arguments] { return simulate(*arguments); }; });
}

}  // namespace selvage::cli
