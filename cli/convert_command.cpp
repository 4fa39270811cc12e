#include "cli/convert_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/answer/read_back.h"
#include "cli/answer/verdict.h"
#include "cli/arguments/frame_range.h"
#include "cli/arguments/output_check.h"
#include "cli/arguments/sequence_argument.h"
#include "cli/process/interrupt.h"
#include "cli/process/terminal.h"
#include "io/file/text.h"
#include "io/points.h"
#include "io/sequence_output.h"
#include "kernel/version.h"
#include "verify/check.h"
#include "verify/report/report.h"

namespace selvage::cli {
namespace {

struct ConvertArguments {
  SequenceArgument sequence;
  std::filesystem::path output;
  std::string frames = ":";
  bool recheck = false, motion = false;
};

struct Conversion {
  std::vector<std::filesystem::path> sources;  ///< of the result
  std::vector<std::uint32_t> checksums;        ///< of its frames
  io::Rounding rounding;
};

bool has_bodies(const std::vector<io::Group>& groups) {
  return std::any_of(groups.begin(), groups.end(),
                     [](const io::Group& group) { return group.role == io::Group::Role::kBody; });
}

/// Throws io::Error where a frame holds no surface, or one that is cloth and body: what would be written of it is
/// refused by its readers, or says less than it.
io::MeshData read_surface(const io::SequenceReader& input, std::size_t frame) {
  io::MeshData mesh = input.frame(frame);
  if (mesh.triangles.empty()) {
    throw io::Error(io::ErrorKind::kBadInput, input.frame_name(frame) + ": no faces: there is nothing to convert");
  }
  io::require_one_role(mesh.groups, input.frame_name(frame));
  return mesh;
}

/// Throws io::Error where what is read would be in the way: who is told to remove it would lose it.
void require_apart_from_input(const ConvertArguments& arguments) {
  std::vector<std::pair<std::filesystem::path, std::string>> made = {{arguments.output, "the result"}};
  if (io::output_format(arguments.output) == io::OutputFormat::kPc2) {
    made.emplace_back(io::base_beside(arguments.output), "the base mesh of " + arguments.output.string());
  }
  for (const std::filesystem::path& input : io::sequence_files(arguments.sequence.sources, arguments.sequence.base)) {
    for (const auto& [file, what] : made) {
      if (!is_one_file(file, input)) continue;
      throw io::Error(io::ErrorKind::kFile, fmt::format("{} is read, and {} would take its place; choose another name",
                                                        file.string(), what));
    }
  }
}

/// Writes frames of `input`; nothing is returned where a signal has stopped it, and nothing is left then.
std::optional<Conversion> write(const io::SequenceReader& input, FrameRange range, const ConvertArguments& arguments) {
  const io::OutputTraits& format = io::traits(io::output_format(arguments.output));
  io::MeshData mesh = read_surface(input, range.begin);
  const auto output = io::create_output(
      arguments.output, {{mesh.triangles, mesh.groups, input.kind(), input.precision(), "selvage " SELVAGE_VERSION},
                         mesh.points.size(),
                         range.end - range.begin});
  Conversion result;
  ProgressBar bar("convert");
  for (std::size_t i = range.begin; i < range.end; ++i) {
    bar.update(i - range.begin, range.end - range.begin);
    if (interrupted()) return std::nullopt;
    if (i > range.begin) mesh = read_surface(input, i);
    if (format.is_float32) io::round_to_float32(mesh.points, result.rounding, input.frame_name(i));
    output->append(input.time(i), mesh);
    result.checksums.push_back(checksum(mesh.points));
  }
  output->finish();
  result.sources = output->sources();
  return result;
}

/// What the input says and the format cannot.
std::vector<std::string> lost(const io::SequenceReader& input, FrameRange range, const io::OutputTraits& format) {
  std::vector<std::string> what;
  bool has_times = false;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    has_times = has_times || input.time(i) != static_cast<double>(i - range.begin);
  }
  if (has_times && !format.keeps_times) what.emplace_back("times");
  if (input.kind() == io::SequenceKind::kSteps && !format.keeps_kind) what.emplace_back("that frames are steps");
  if (has_bodies(input.groups()) && !format.keeps_roles) what.emplace_back("which faces are bodies");
  if (!input.groups().empty() && !format.keeps_group_names) what.emplace_back("names of groups");
  return what;
}

/// The bodies by name, and how selvage verify is told of them; as cloth their overlaps would be violations.
void print_bodies(const std::vector<io::Group>& groups) {
  std::set<std::string> bodies, cloths;
  for (const io::Group& group : groups) {
    (group.role == io::Group::Role::kBody ? bodies : cloths).insert(group.name);
  }
  if (bodies.empty()) return;
  std::string names, options, shared;
  for (const std::string& body : bodies) {
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", body);
    if (cloths.contains(body)) {
      shared += fmt::format("; \"{}\" is the name of cloth too: rename one before", body);
    } else {
      options += " --body " + io::shell_word(body);
    }
  }
  if (options.empty()) options = " --body";
  fmt::print("bodies:    {}\n",
             io::printable(fmt::format("{}; selvage verify takes them for cloth without{}{}", names, options, shared)));
}

void print_conversion(const io::SequenceReader& input, FrameRange range, const io::OutputTraits& format,
                      const Conversion& conversion) {
  const auto name_of = [](const std::filesystem::path& file) { return io::printable(file.string()); };
  fmt::print("written:   {}{}, {} frames as {}\n", name_of(conversion.sources.front()),
             conversion.sources.size() > 1 ? " ... " + name_of(conversion.sources.back()) : "", range.end - range.begin,
             format.name);
  const char* from = input.precision() == io::Precision::kFloat32 ? "float32" : "float64";
  if (!format.is_float32) {
    fmt::print("precision: {}, every value kept\n", from);
  } else {
    const io::Rounding& rounding = conversion.rounding;
    fmt::print("precision: {} to float32, rounded to nearest: {} of {} values changed, the largest by {:.17g}\n", from,
               rounding.changed, rounding.values, rounding.largest_change);
  }
  const std::vector<std::string> missing = lost(input, range, format);
  if (!missing.empty()) fmt::print("not kept:  {}\n", fmt::join(missing, ", "));
  if (!format.keeps_roles) print_bodies(input.groups());
}

/// As many as fit on a terminal; selvage verify lists more.
constexpr std::size_t kListed = 10;

/// Checks the file, not what was in memory; with the roles and the kind of the input where the format has none.
ExitCode recheck(const io::SequenceReader& input, Conversion conversion, const ConvertArguments& arguments) {
  Claims claims;
  claims.kind = input.kind();
  claims.keeps_groups = !has_bodies(input.groups());
  claims.groups = input.groups();
  const auto written = read_back(io::open_sequence(conversion.sources), claims, std::move(conversion.checksums));
  verify::SequenceOptions options;
  options.motions = written->frame_count() > 1 && (arguments.motion || input.kind() == io::SequenceKind::kSteps);
  ProgressBar bar("recheck");
  options.progress = [&](std::size_t done, std::size_t total) {
    bar.update(done, total);
    return !interrupted();
  };
  const verify::SequenceReport report = verify::check_sequence(*written, options);
  verify::ReportContext context{"selvage " SELVAGE_VERSION, {}, {}};
  context.is_rounded = conversion.rounding.changed > 0;
  for (const auto& source : conversion.sources) context.sources.push_back(source.string());
  for (std::size_t i = 0; i < written->frame_count(); ++i) context.frame_names.emplace(i, written->frame_name(i));
  fmt::print("as written: ");
  print_report(verify::text_report(report, context, kListed), report.verdict);
  return exit_code(report);
}

ExitCode run(const ConvertArguments& arguments) {
  catch_interrupts();
  require_no_dash(arguments.output);
  const auto input = open_sequence(arguments.sequence);
  if (input->frame_count() == 0) {
    throw io::Error(io::ErrorKind::kBadInput, "the sequence holds no frame: there is nothing to convert");
  }
  require_apart_from_input(arguments);
  const FrameRange range = parse_frame_range(arguments.frames, input->frame_count());
  const io::OutputTraits& format = io::traits(io::output_format(arguments.output));
  if (arguments.recheck && !format.is_read) {
    throw UsageError(
        fmt::format("--recheck reads the file again, and {} is not read; its numbers are those of the "
                    "input: verify that",
                    format.name));
  }
  if (arguments.motion && range.end - range.begin == 1) {
    throw UsageError("--motion needs at least two frames, and there is one: no motion would be checked");
  }
  std::optional<Conversion> conversion = write(*input, range, arguments);
  if (!conversion) {
    say("selvage: interrupted; nothing was written\n");
    return ExitCode::kInterrupted;
  }
  print_conversion(*input, range, format, *conversion);
  return arguments.recheck ? recheck(*input, std::move(*conversion), arguments) : ExitCode::kClean;
}

/// An unknown extension is a mistake on the command line.
std::string check_output(const std::string& output) {
  try {
    (void)io::output_format(output);
  } catch (const io::Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace

void add_convert_command(CLI::App& program, Job& job) {
  CLI::App& command = add_command(program, "convert", "Write a sequence in another format, and check it as written",
                                  "selvage convert run/ -o cloth.pc2 --recheck");
  const auto arguments = std::make_shared<ConvertArguments>();
  add_sequence_argument(command, arguments->sequence);
  command
      .add_option("-o,--output", arguments->output,
                  "An .npz, .obj, .pc2 or .pvd file, or a folder; must not be there yet")
      ->required()
      ->check(CLI::Validator(check_output, "", ""));
  command
      .add_option("--frames", arguments->frames, "Frames a to b, b left out; from 0; :b from the first, a: to the last")
      ->type_name("A:B");
  CLI::Option* recheck = command.add_flag("--recheck", arguments->recheck,
                                          "Read the result again and check it exactly: rounding makes intersections");
  command
      .add_flag("--motion", arguments->motion,
                "Check the motion between frames too (default only where the input says it holds steps)")
      ->needs(recheck);
  command.callback([arguments, &job] { job = [arguments] { return run(*arguments); }; });
}

}  // namespace selvage::cli
