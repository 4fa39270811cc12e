#include "cli/arguments/group_names.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/process/exit_code.h"

namespace selvage::cli {
namespace {

std::string list_of(const std::vector<io::Group>& groups) {
  if (groups.empty()) return "the sequence has no groups";
  constexpr std::size_t kMaxNamed = 20;  // as many as a person reads through
  std::vector<std::string> listed;
  std::string text = "the groups are";
  for (const io::Group& group : groups) {
    if (std::ranges::find(listed, group.name) != listed.end()) continue;
    if (listed.size() == kMaxNamed) return text + ", ...";
    text += fmt::format("{} \"{}\"", listed.empty() ? "" : ",", group.name);
    listed.push_back(group.name);
  }
  return text;
}

}  // namespace

void require_known(const std::string& option, const std::vector<std::string>& names,
                   const std::vector<io::Group>& groups) {
  for (const std::string& name : names) {
    if (std::ranges::find(groups, name, &io::Group::name) != groups.end()) continue;
    throw UsageError(fmt::format("{}: no group \"{}\"; {}", option, name, list_of(groups)));
  }
}

}  // namespace selvage::cli
