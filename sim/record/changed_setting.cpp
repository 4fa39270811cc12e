#include "sim/record/changed_setting.h"

#include <algorithm>
#include <sstream>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "io/file/text.h"
#include "sim/scene/toml_parser.h"

namespace selvage::sim {
namespace {

constexpr std::size_t kShownBytes = 60;  // of a value: a list of vertices does not fill the terminal

struct Setting {
  std::string path, value;
  std::size_t line = 0;
};

std::string text_of(const toml::node& node) {
  // 40 and 40.0 are one value.
  if (const auto number = node.value<double>(); number && node.is_number()) return fmt::format("{}", *number);
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  return text.str();
}

void collect(const toml::node& node, const std::string& path, std::vector<Setting>& settings) {
  if (const toml::table* table = node.as_table()) {
    if (table->empty()) settings.push_back({path, "{}", node.source().begin.line});
    for (const auto& [key, value] : *table) {
      collect(value, path + (path.empty() ? "" : ".") + std::string(key.str()), settings);
    }
    return;
  }
  const toml::array* array = node.as_array();
  if (array != nullptr && array->is_array_of_tables()) {
    for (std::size_t i = 0; i < array->size(); ++i) collect((*array)[i], fmt::format("{}[{}]", path, i), settings);
    return;
  }
  if (array == nullptr) {
    settings.push_back({path, text_of(node), node.source().begin.line});
    return;
  }
  std::string list;
  for (const toml::node& item : *array) list += (list.empty() ? "" : ", ") + text_of(item);
  settings.push_back({path, "[" + list + "]", node.source().begin.line});
}

/// In the order of the lines.
std::vector<Setting> settings_of(std::string_view text) {
  std::vector<Setting> settings;
  collect(toml::parse(text), "", settings);
  std::ranges::stable_sort(settings, {}, &Setting::line);
  return settings;
}

using SettingsByPath = std::unordered_map<std::string_view, const Setting*>;

/// The first of each path.
SettingsByPath by_path(const std::vector<Setting>& all) {
  SettingsByPath result;
  for (const Setting& setting : all) result.try_emplace(setting.path, &setting);
  return result;
}

std::string shown(const std::string& value) { return io::printable(value, kShownBytes); }

}  // namespace

std::optional<std::string> changed_setting(std::string_view before, std::string_view now) {
  if (before == now) return std::nullopt;
  const std::vector<Setting> old_settings = settings_of(before), settings = settings_of(now);
  const SettingsByPath old_by_path = by_path(old_settings), now_by_path = by_path(settings);
  for (const Setting& setting : settings) {
    const auto found = old_by_path.find(setting.path);
    if (found == old_by_path.end()) {
      return fmt::format("{} (line {}) is {} and was not there", setting.path, setting.line, shown(setting.value));
    }
    const std::string& old_value = found->second->value;
    if (old_value != setting.value) {
      return fmt::format("{} (line {}) was {} and is {}", setting.path, setting.line, shown(old_value),
                         shown(setting.value));
    }
  }
  for (const Setting& old : old_settings) {
    if (!now_by_path.contains(old.path)) {
      return fmt::format("{} was {} and is not there any more", old.path, shown(old.value));
    }
  }
  return std::nullopt;
}

}  // namespace selvage::sim
