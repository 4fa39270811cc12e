#include "cli/frame_numbers.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include <fmt/format.h>

namespace selvage::cli {
namespace {

bool is_digit(char c) { return '0' <= c && c <= '9'; }

/// A name whose numbers are taken out of the part before the extension.
struct NumberedName {
  std::string text;  ///< with the folder, and a digit in place of each number
  std::vector<std::int64_t> numbers;
};

std::optional<NumberedName> numbered(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  NumberedName result{(file.parent_path() / "").string(), {}};
  for (const char *at = stem.data(), *const end = at + stem.size(); at != end;) {
    if (!is_digit(*at)) {
      result.text += *at++;
      continue;
    }
    const auto [behind, error] = std::from_chars(at, end, result.numbers.emplace_back());
    if (error != std::errc()) return std::nullopt;
    result.text += '0';
    at = behind;
  }
  result.text += file.extension().string();
  return result;
}

/// Which of the numbers is the frame's: the only one that changes, or the last.
std::optional<std::size_t> frame_number(const std::vector<NumberedName>& names) {
  const std::vector<std::int64_t>& first = names.front().numbers;
  std::optional<std::size_t> found;
  for (std::size_t n = 0; n < first.size(); ++n) {
    const auto is_first = [&](const NumberedName& name) { return name.numbers[n] == first[n]; };
    if (std::ranges::all_of(names, is_first)) continue;
    if (found) return std::nullopt;
    found = n;
  }
  if (!found && !first.empty()) found = first.size() - 1;
  return found;
}

}  // namespace

std::optional<std::string> jump_in_numbers(const std::vector<std::filesystem::path>& files) {
  std::vector<NumberedName> names;
  for (const auto& file : files) {
    const auto name = numbered(file);
    if (!name) return std::nullopt;
    names.push_back(*name);
    if (name->text != names.front().text) return std::nullopt;
  }
  const std::optional<std::size_t> number = names.empty() ? std::nullopt : frame_number(names);
  if (!number) return std::nullopt;
  const auto difference = [&](std::size_t i) { return names[i].numbers[*number] - names[i - 1].numbers[*number]; };
  std::int64_t step = 0;
  for (std::size_t i = 1; i < names.size(); ++i) {
    if (difference(i) > 0 && (step == 0 || difference(i) < step)) step = difference(i);
  }
  for (std::size_t i = 1; i < names.size(); ++i) {
    if (difference(i) == step && step > 0) continue;
    return fmt::format("{} comes right after {}; what is missing between is not checked", files[i].string(),
                       files[i - 1].string());
  }
  return std::nullopt;
}

}  // namespace selvage::cli
