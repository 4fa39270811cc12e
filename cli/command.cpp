#include "cli/command.h"

#include <memory>
#include <utility>
#include <vector>

namespace selvage::cli {
namespace {

class ExampleFirst : public CLI::Formatter {
 public:
  explicit ExampleFirst(std::string example) : example_(std::move(example)) {}
  std::string make_description(const CLI::App* app) const override {
    return "Example: " + example_ + "\n\n" + CLI::Formatter::make_description(app);
  }

 private:
  std::string example_;
};

}  // namespace

void show_example_first(CLI::App& app, const std::string& example) {
  app.formatter(std::make_shared<ExampleFirst>(example));
}

CLI::App& add_command(CLI::App& program, const std::string& name, const std::string& description,
                      const std::string& example) {
  CLI::App& command = *program.add_subcommand(name, description);
  show_example_first(command, example);
  return command;
}

void require_one_subcommand(CLI::App& command, Job& job) {
  command.require_subcommand(0, 1);
  command.allow_extras();  // to name them ourselves: CLI11 says of an unknown one only that one is required
  command.callback([&command, &job] {
    const std::vector<std::string> unknown = command.remaining();
    if (!command.get_subcommands().empty() && unknown.empty()) return;
    std::string names;
    for (const CLI::App* known : command.get_subcommands({})) names += (names.empty() ? "" : ", ") + known->get_name();
    const std::string what = unknown.empty() ? "a subcommand is required" : "no subcommand '" + unknown.front() + "'";
    job = [message = command.get_name() + ": " + what + "; there are " + names]() -> ExitCode {
      throw UsageError(message);
    };
  });
}

}  // namespace selvage::cli
