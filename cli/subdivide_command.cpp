#include "cli/subdivide_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "cli/answer/mesh_faults.h"
#include "cli/arguments/named_bodies.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/arguments/sequence_argument.h"
#include "cli/arguments/thread_limit.h"
#include "cli/process/interrupt.h"
#include "cli/process/terminal.h"
#include "io/file/text.h"
#include "io/sequence/sequence_outputs.h"
#include "kernel/types.h"
#include "kernel/version.h"
#include "sim/base/points.h"
#include "sim/subdivision/subdivision.h"
#include "verify/check.h"

namespace selvage::cli {
namespace {

struct SubdivideArguments {
  SequenceArgument sequence;
  std::vector<std::string> body;
  std::filesystem::path output;
  std::int32_t levels = 1;
  std::optional<std::size_t> frame;
  ThreadLimit threads;
};

// 4^6 times the faces; a scene's draft has 10^7 then.
constexpr std::int32_t kMaxLevels = 6;

/// Of a frame, exactly.
struct Intersections {
  std::int64_t count = 0;
  std::array<std::int32_t, 2> first{};  ///< faces; twice the same for one without area
};

/// Nothing where a signal has arrived, for which whoever asks looks.
Intersections find_intersections(const io::Triangles& triangles, const std::vector<io::Group>& groups,
                                 const io::Points& V) {
  const std::vector<std::uint8_t> is_body = io::body_faces(triangles.size(), groups);
  verify::CheckOptions options;
  options.max_violations = 1;
  options.stop = interrupted;
  try {
    const verify::CheckResult found = verify::check_frame(verify::Surface{triangles, is_body}, V, options);
    if (found.violations.empty()) return {};
    const verify::Violation& first = found.violations.front();
    return {found.violations_total.total(), verify::faces_of(first)};
  } catch (const verify::Stopped&) {
    return {};
  }
}

/// Throws io::Error unless frame `frame` can be subdivided by the rules of the first one.
io::MeshData read_frame(const io::SequenceReader& input, std::size_t frame, const io::MeshData& first) {
  io::MeshData mesh = input.frame(frame);
  const std::string name = input.frame_name(frame);
  const auto differs = [&name](const std::string& what) {
    return io::Error(io::ErrorKind::kBadInput, name + ": " + what +
                                                   "; subdivide such frames one by one with --frame, each into a "
                                                   "folder of its own");
  };
  if (mesh.points.size() != first.points.size()) {
    throw differs(fmt::format("{} vertices, the first frame has {}", mesh.points.size(), first.points.size()));
  }
  if (mesh.triangles != first.triangles) throw differs("its faces are not those of the first frame");
  if (mesh.groups != first.groups) throw differs("its groups are not those of the first frame");
  sim::require_in_domain(mesh.points, name);
  return mesh;
}

/// Incomplete where a signal has arrived, for which whoever asks looks.
struct FineFrame {
  io::Points points;
  sim::SubdivisionCounts counts;
  Intersections before, after;
};

FineFrame subdivide(const sim::Subdivision& subdivision, const io::MeshData& mesh,
                    const std::vector<io::Group>& groups) {
  FineFrame fine;
  fine.before = find_intersections(mesh.triangles, groups, mesh.points);
  if (fine.before.count > 0) return fine;  // section 8 begins with a frame that is free of intersections
  Positions V(static_cast<Eigen::Index>(mesh.points.size()), 3);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    V.row(static_cast<Eigen::Index>(i)) << mesh.points[i][0], mesh.points[i][1], mesh.points[i][2];
  }
  fine.points = sim::points_of(subdivision(V, fine.counts, interrupted));
  if (interrupted()) return fine;
  fine.after = find_intersections(subdivision.triangles(), subdivision.groups(), fine.points);
  return fine;
}

std::string pairs_intersect(std::int64_t count) {
  return count == 1 ? "1 pair intersects" : fmt::format("{} pairs intersect", count);
}

/// What is wrong with the mesh itself where these faces of the input intersect, with the remedy; or what else to do.
std::string remedy(const io::MeshData& mesh, const std::array<std::int32_t, 2>& faces) {
  if (faces[0] == faces[1]) return "take it out of the mesh";
  if (is_of_one_fan(mesh.triangles, faces)) return fan_remedy(faces);
  const std::set<std::int32_t> at_seam = coincident_corners(mesh.triangles, mesh.points, faces);
  if (!at_seam.empty()) {
    return fmt::format(
        "corners of them lie at one place, such as vertex {}, as where a mesh is split at seams: weld them (merge by "
        "distance 0) in the program that wrote it; else free the frame",
        *at_seam.begin());
  }
  return "free the frame";
}

/// What keeps the frame from being written, as faces of the input.
std::string describe(const FineFrame& fine, const io::MeshData& mesh, std::int32_t levels, bool has_others) {
  const bool is_input = fine.before.count > 0;
  const Intersections& found = is_input ? fine.before : fine.after;
  const std::int32_t parts = is_input ? 1 : 1 << (2 * levels);  // face f becomes faces 4 f .. 4 f + 3 at every level
  const std::int32_t f = found.first[0] / parts, g = found.first[1] / parts;
  const std::string pairs = pairs_intersect(found.count);
  const std::string others = has_others ? ", or subdivide the others one by one with --frame" : "";
  if (is_input) {
    return fmt::format(
        "{} already, the first {}; nothing is written: {}{}", pairs,
        f == g ? fmt::format("is face {}, which has no area", f) : fmt::format("of faces {} and {}", f, g),
        remedy(mesh, {f, g}), others);
  }
  return fmt::format("{} after subdivision, the first {}; nothing is written: {}{}", pairs,
                     f == g ? fmt::format("within face {}, which is too thin for the rounding of its midpoints", f)
                            : fmt::format("of faces {} and {}, which are nearer than midpoints can be rounded", f, g),
                     f == g ? "take it out" : "move them apart", others);
}

void print_what_was_checked(const io::MeshData& mesh) {
  const std::vector<std::uint8_t> is_body = io::body_faces(mesh.triangles.size(), mesh.groups);
  const auto bodies = std::ranges::count(is_body, 1);
  if (bodies == 0 && mesh.groups.size() > 1) {
    std::string names;
    for (const io::Group& group : mesh.groups) names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", group.name);
    fmt::print("all groups are taken for cloth: {}; --body NAME says which is none\n", io::printable(names));
  }
  if (bodies == std::ssize(is_body)) {
    fmt::print("nothing was smoothed or checked: all faces belong to bodies\n");
  } else {
    fmt::print("every frame checked exactly, before and after: 0 intersections{}\n",
               bodies > 0 ? "; bodies not against each other or themselves" : "");
  }
}

ExitCode run(const SubdivideArguments& arguments) {
  catch_interrupts();
  const auto threads = arguments.threads.hold();
  require_folder_name(arguments.output);
  const auto input = with_bodies(open_sequence(arguments.sequence), arguments.body, {});
  if (arguments.frame && *arguments.frame >= input->frame_count()) {
    throw UsageError(fmt::format("--frame {}: there is no such frame; the last one is {}", *arguments.frame,
                                 input->frame_count() - 1));
  }
  const std::size_t begin = arguments.frame.value_or(0);
  const std::size_t end = arguments.frame ? begin + 1 : input->frame_count();
  const io::MeshData first = input->frame(begin);
  if (first.triangles.empty()) {
    throw io::Error(io::ErrorKind::kBadInput, input->frame_name(begin) + ": no faces: there is nothing to subdivide");
  }
  if (!sim::may_subdivide(first.triangles.size(), arguments.levels)) {
    throw UsageError(fmt::format("--levels {}: {} faces would become more than {}, all that a mesh may have; lower it",
                                 arguments.levels, first.triangles.size(), kMaxFaceCount));
  }
  const std::vector<io::Group>& groups = first.groups;
  io::require_one_role(groups, input->frame_name(begin));
  const sim::Subdivision subdivision(first.triangles, static_cast<std::int32_t>(first.points.size()), groups,
                                     arguments.levels);
  io::MeshData written{{}, subdivision.triangles(), subdivision.groups(), io::Precision::kFloat64};
  const auto output = io::create_folder_output(
      arguments.output,
      {{written.triangles, written.groups, io::SequenceKind::kFrames, written.precision, "selvage " SELVAGE_VERSION},
       static_cast<std::size_t>(subdivision.vertex_count()),
       end - begin});
  sim::SubdivisionCounts counts;
  ProgressBar bar("subdividing");
  const auto batch = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  for (std::size_t frame = begin; frame < end; frame += batch) {
    bar.update(frame - begin, end - begin);
    std::vector<FineFrame> fine(std::min(batch, end - frame));
    // Read before, one by one: an error there would cancel the loops within the checks of the other frames.
    std::vector<io::MeshData> coarse;
    for (std::size_t k = 0; k < fine.size(); ++k) coarse.push_back(read_frame(*input, frame + k, first));
    tbb::parallel_for(std::size_t{0}, fine.size(),
                      [&](std::size_t k) { fine[k] = subdivide(subdivision, coarse[k], groups); });
    if (interrupted()) {
      say("selvage: interrupted; nothing was written\n");
      return ExitCode::kInterrupted;
    }
    for (std::size_t k = 0; k < fine.size(); ++k) {
      if (fine[k].before.count + fine[k].after.count > 0) {
        const std::string name = io::printable(input->frame_name(frame + k));
        say("selvage: {}: {}\n", name, describe(fine[k], coarse[k], arguments.levels, end - begin > 1));
        return ExitCode::kViolation;
      }
      written.points = std::move(fine[k].points);
      output->append(input->time(frame + k), written);
      counts.rounds += fine[k].counts.rounds;
      counts.stopped += fine[k].counts.stopped;
    }
  }
  output->finish();
  fmt::print("{} frames, {} faces to {}\n", end - begin, first.triangles.size(), subdivision.triangles().size());
  fmt::print("vertices stopped before a touch {}, in {} further rounds\n", counts.stopped, counts.rounds);
  print_what_was_checked(first);
  return ExitCode::kClean;
}

}  // namespace

void add_subdivide_command(CLI::App& program, Job& job) {
  CLI::App& command = add_command(program, "subdivide", "Write finer and smoother frames, free of intersections",
                                  "selvage subdivide demo/curtain -o demo/smooth --levels 2");
  const auto arguments = std::make_shared<SubdivideArguments>();
  add_sequence_argument(command, arguments->sequence);
  command
      .add_option("-o,--output", arguments->output, "The sequence folder to write; must not be there yet, or be empty")
      ->required();
  command
      .add_option("--body", arguments->body,
                  "A is a body, where the format cannot say so: not smoothed, and not checked against bodies and "
                  "itself; may be repeated")
      ->allow_extra_args(false)
      ->type_name("A");
  command.add_option("--levels", arguments->levels, "How often every face is split into four")
      ->check(whole_between(1, kMaxLevels))
      ->capture_default_str();
  command.add_option("--frame", arguments->frame, "This frame alone; from 0")->check(whole_number());
  add_threads(command, arguments->threads);
  command.callback([arguments, &job] { job = [arguments] { return run(*arguments); }; });
}

}  // namespace selvage::cli
