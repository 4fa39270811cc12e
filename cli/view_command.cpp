#include "cli/view_command.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/answer/result.h"
#include "cli/arguments/choice.h"
#include "cli/arguments/hidden_groups.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/arguments/sequence_argument.h"
#include "cli/page/player_page.h"
#include "cli/page/report_words.h"
#include "cli/process/terminal.h"

namespace selvage::cli {
namespace {

struct ViewArguments {
  SequenceArgument sequence;
  std::vector<std::string> hidden;
  std::filesystem::path page;
  std::int64_t max_mb = 50;
  page::UpAxis up = page::UpAxis::kZ;
};

ExitCode view_sequence(const ViewArguments& arguments) {
  require_outputs_apart_from(arguments.sequence, {arguments.page});
  require_writable({arguments.page});
  const auto sequence = without_groups(open_sequence(arguments.sequence), arguments.hidden);
  const std::string title = source_names({arguments.sequence.sources.begin(), arguments.sequence.sources.end()});
  ProgressBar bar("packing");
  const PlayerPage made =
      player_page(title, *sequence, arguments.up, static_cast<std::size_t>(arguments.max_mb) * 1000 * 1000,
                  [&](std::size_t done, std::size_t total) { bar.update(done, total); });
  write_report(arguments.page, made.html);
  print_result(made.summary + "\n", {arguments.page});
  return ExitCode::kClean;
}

}  // namespace

void add_view_command(CLI::App& program, Job& job) {
  CLI::App& command =
      add_command(program, "view",
                  "Write a page that plays a sequence in the browser, offline; for looking at, positions are rounded",
                  "selvage view demo/curtain -o page.html");
  const auto arguments = std::make_shared<ViewArguments>();
  add_sequence_argument(command, arguments->sequence);
  command.add_option("-o,--output", arguments->page, "The HTML file")->required();
  add_hide(command, arguments->hidden);
  command
      .add_option("--max-mb", arguments->max_mb,
                  "At most this much of meshes: else every second, third, ... frame only, and the last")
      ->check(whole_between(1, 2000))
      ->capture_default_str();
  add_choice(command, "--up", arguments->up, {{"y", page::UpAxis::kY}, {"z", page::UpAxis::kZ}},
             "The axis that points up (default: z; the page can change it)");
  command.callback([arguments, &job] { job = [arguments] { return view_sequence(*arguments); }; });
}

}  // namespace selvage::cli
