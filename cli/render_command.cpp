#include "cli/render_command.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/arguments/choice.h"
#include "cli/arguments/hidden_groups.h"
#include "cli/arguments/list_option.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/arguments/sequence_argument.h"
#include "cli/process/interrupt.h"
#include "cli/process/terminal.h"
#include "cli/render/contact_sheet.h"
#include "io/file/extension.h"

namespace selvage::cli {
namespace {

struct RenderArguments {
  SequenceArgument sequence;
  std::vector<std::string> hidden;
  std::filesystem::path picture;
  std::vector<std::size_t> frames;
  std::size_t tiles = 12;
  int columns = 4;
  int width = 1600;
  View view;
};

ExitCode render_sequence(const RenderArguments& arguments) {
  catch_interrupts();
  require_outputs_apart_from(arguments.sequence, {arguments.picture});
  require_writable({arguments.picture});
  const auto sequence = without_groups(open_sequence(arguments.sequence), arguments.hidden);
  SheetOptions options{arguments.frames, arguments.columns, arguments.width, arguments.view};
  if (options.frames.empty()) options.frames = spread_frames(*sequence, arguments.tiles);
  for (const std::size_t frame : options.frames) {
    if (frame >= sequence->frame_count()) {
      throw UsageError(fmt::format("--frames {}: the sequence has {} frames, from 0", frame, sequence->frame_count()));
    }
  }
  if (options.frames.empty()) throw io::Error(io::ErrorKind::kBadInput, "the sequence has no frames; nothing to draw");
  ProgressBar bar("drawing");
  const std::optional<io::Picture> sheet = render_sheet(*sequence, options, [&](std::size_t done, std::size_t total) {
    bar.update(done, total);
    return !interrupted();
  });
  if (!sheet) {
    say("selvage: interrupted; nothing was written\n");
    return ExitCode::kInterrupted;
  }
  io::write_png(arguments.picture, *sheet);
  return ExitCode::kClean;
}

}  // namespace

void add_render_command(CLI::App& program, Job& job) {
  CLI::App& command =
      add_command(program, "render", "Draw frames of a sequence on one picture: cloth warm in front and cool behind",
                  "selvage render demo/curtain -o sheet.png");
  const auto arguments = std::make_shared<RenderArguments>();
  add_sequence_argument(command, arguments->sequence);
  command.add_option("-o,--output", arguments->picture, "The PNG file")
      ->required()
      ->check(CLI::Validator(
          [](const std::string& name) {
            return std::string(
                io::has_extension(name, ".png") ? "" : name + ": only PNG is drawn; let the name end in .png");
          },
          "", ""));
  add_hide(command, arguments->hidden);
  CLI::Option* frames = add_list(command, "--frames", arguments->frames, "Frames to draw")->check(whole_number());
  command.add_option("--tiles", arguments->tiles, "How many frames, spread evenly in time")
      ->check(whole_between(1, 1000))
      ->capture_default_str()
      ->excludes(frames);
  command.add_option("--columns", arguments->columns, "Tiles a row")
      ->check(whole_between(1, 100))
      ->capture_default_str();
  command.add_option("--width", arguments->width, "Pixels of the whole sheet")
      ->check(whole_between(200, 10000))
      ->capture_default_str();
  command.add_option("--azimuth", arguments->view.azimuth_deg, "Where the camera stands about the up axis, degrees")
      ->check(number_between(-360, 360))
      ->capture_default_str();
  command.add_option("--elevation", arguments->view.elevation_deg, "The camera's height above the horizon, degrees")
      ->check(number_between(-89, 89))
      ->capture_default_str();
  add_choice(command, "--up", arguments->view.up, {{"y", UpAxis::kY}, {"z", UpAxis::kZ}},
             "The axis that points up (default: z)");
  command.callback([arguments, &job] { job = [arguments] { return render_sequence(*arguments); }; });
}

}  // namespace selvage::cli
