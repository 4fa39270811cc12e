#include "cli/command.h"

#include <memory>
#include <utility>

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

}  // namespace selvage::cli
