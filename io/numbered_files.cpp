#include "io/numbered_files.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include "io/fail.h"

namespace selvage::io {

namespace fs = std::filesystem;

namespace {

bool is_digits(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

struct NumberedFile {
  std::int64_t number;
  std::string digits;  ///< of which some may be leading zeros
  fs::path file;
};

std::optional<std::int64_t> frame_number(std::string_view digits) {
  constexpr std::size_t kMaxDigits = 18;  // of every such number std::int64_t holds the double
  std::int64_t number = 0;
  if (digits.size() > kMaxDigits || !is_digits(digits)) return std::nullopt;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

/// Whether it is a number that no frame has: one that was passed over would be a frame that is not missed.
bool is_other_number(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  const std::size_t point = std::min(text.find('.'), text.size());
  return is_digits(text.substr(0, point)) && (point == text.size() || is_digits(text.substr(point + 1)));
}

/// `number` with as many digits as its neighbour below has.
std::string digits_like(const std::string& neighbour, std::int64_t number) {
  const std::string digits = std::to_string(number);
  return std::string(neighbour.size() - std::min(neighbour.size(), digits.size()), '0') + digits;
}

/// Names the first that is missing where the numbers go up by the smallest step or a multiple of it.
void require_one_step(const fs::path& pattern, std::string_view before, std::string_view after,
                      std::span<const NumberedFile> found) {
  std::int64_t step = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 1; i < found.size(); ++i) step = std::min(step, found[i].number - found[i - 1].number);
  for (std::size_t i = 1; i < found.size(); ++i) {
    const NumberedFile &last = found[i - 1], &next = found[i];
    const std::string from = last.file.filename().string(), to = next.file.filename().string();
    if (last.number == next.number)
      bad_input(pattern.string(), from + " and " + to + " have the same number; keep one");
    if (step == 0 || next.number - last.number == step) continue;  // 0: two others have one number
    if ((next.number - last.number) % step != 0) {
      bad_input(pattern.string(), "after " + from + " comes " + to +
                                      ", and the numbers do not go up by one step; move away what is no frame");
    }
    std::string missing(before);
    missing += digits_like(last.digits, last.number + step);
    missing += after;
    file_error((pattern.parent_path() / missing).string(), "open", ENOENT,
               "it is missing between " + from + " and " + to + ": add it, or move away what is no frame");
  }
}

}  // namespace

std::vector<fs::path> numbered_files(const fs::path& pattern) {
  const std::string name = pattern.filename().string();
  const std::size_t star = name.find('*');
  if (star == std::string::npos) return {pattern};
  const std::string_view before = std::string_view(name).substr(0, star),
                         after = std::string_view(name).substr(star + 1);
  if (after.find('*') != std::string_view::npos) {
    bad_input(pattern.string(), "two * in one name; put one in the place of the frame's number");
  }
  std::vector<NumberedFile> found;
  std::error_code status;
  const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, status), end; !status && entry != end; entry.increment(status)) {
    const std::string file = entry->path().filename().string();
    if (file.size() <= before.size() + after.size() || !file.starts_with(before) || !file.ends_with(after)) continue;
    const char *begin = file.data() + before.size(), *stop = file.data() + file.size() - after.size();
    const std::string digits(begin, stop);
    if (const auto number = frame_number(digits)) {
      found.push_back({*number, digits, pattern.parent_path() / file});
    } else if (is_other_number(digits)) {
      bad_input((pattern.parent_path() / file).string(),
                "frames are numbered 0, 1, ... up to 18 digits, without sign or fraction; rename it, or move it away");
    }
  }
  if (status) file_error(folder.string(), "list", status.value());
  if (found.empty()) {
    file_error(pattern.string(), "open", ENOENT, "no file has such a name with a number for *; check the path");
  }
  std::ranges::sort(found, {}, [](const NumberedFile& f) { return std::tie(f.number, f.file); });
  require_one_step(pattern, before, after, found);
  std::vector<fs::path> files;
  for (NumberedFile& each : found) files.push_back(std::move(each.file));
  return files;
}

}  // namespace selvage::io
