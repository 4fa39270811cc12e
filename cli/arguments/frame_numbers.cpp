#include "cli/arguments/frame_numbers.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include <fmt/format.h>

namespace selvage::cli {
namespace {

bool is_digit(char c) { return '0' <= c && c <= '9'; }
bool is_divider(char c) { return c == '.' || c == '_' || c == '-' || c == ' '; }

/// A name whose numbers are taken out of the part before the extension. Folder and extension say nothing of frames.
struct NumberedName {
  std::string text;  ///< a digit in place of each number
  std::vector<std::int64_t> numbers;
};

NumberedName numbered(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  NumberedName result;
  for (const char *at = stem.data(), *const end = at + stem.size(); at != end;) {
    // What stands behind a letter or a number divides, as in shot-12; else it is the sign of a frame before the first.
    const bool is_sign = *at == '-' && at + 1 != end && is_digit(at[1]) && (at == stem.data() || is_divider(at[-1]));
    if (!is_sign && !is_digit(*at)) {
      result.text += *at++;
      continue;
    }
    std::int64_t number = 0;
    const auto [behind, error] = std::from_chars(at, end, number);
    if (error == std::errc()) {
      result.numbers.push_back(number);
      result.text += '0';
    } else {
      result.text.append(at, behind);  // longer than any frame's
    }
    at = behind;
  }
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
    names.push_back(numbered(file));
    if (names.back().text != names.front().text) return std::nullopt;
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
    const bool is_elsewhere = std::ranges::any_of(
        names, [&](const NumberedName& name) { return name.numbers[*number] == names[i - 1].numbers[*number] + step; });
    return fmt::format(
        "{} comes right after {}; {}", files[i].string(), files[i - 1].string(),
        difference(i) > 0 && !is_elsewhere
            ? "what is missing between is not checked"
            : "files are checked in the order in which they are named, which is not that of their numbers");
  }
  return std::nullopt;
}

}  // namespace selvage::cli
