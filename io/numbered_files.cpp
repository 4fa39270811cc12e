#include "io/numbered_files.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/fail.h"

namespace selvage::io {

namespace fs = std::filesystem;

std::vector<fs::path> numbered_files(const fs::path& pattern) {
  const std::string name = pattern.filename().string();
  const std::size_t star = name.find('*');
  if (star == std::string::npos) return {pattern};
  const std::string_view before = std::string_view(name).substr(0, star),
                         after = std::string_view(name).substr(star + 1);
  if (after.find('*') != std::string_view::npos) {
    bad_input(pattern.string(), "two * in one name; put one in the place of the frame's number");
  }
  std::vector<std::pair<std::int64_t, fs::path>> found;
  std::error_code status;
  const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
  for (fs::directory_iterator entry(folder, status), end; !status && entry != end; entry.increment(status)) {
    const std::string file = entry->path().filename().string();
    if (file.size() <= before.size() + after.size() || !file.starts_with(before) || !file.ends_with(after)) continue;
    const char *begin = file.data() + before.size(), *stop = file.data() + file.size() - after.size();
    std::int64_t number = 0;
    const auto [behind, error] = std::from_chars(begin, stop, number);
    if (error == std::errc() && behind == stop && number >= 0) found.emplace_back(number, pattern.parent_path() / file);
  }
  if (status) file_error(folder.string(), "list", status.value());
  if (found.empty()) bad_input(pattern.string(), "no file has such a name with a number for *; check the path");
  std::ranges::sort(found);
  const std::int64_t step = found.size() > 1 ? found[1].first - found[0].first : 1;
  std::vector<fs::path> files{found.front().second};
  for (std::size_t i = 1; i < found.size(); ++i) {
    if (step == 0 || found[i].first - found[i - 1].first != step) {
      bad_input(pattern.string(), "after " + found[i - 1].second.filename().string() + " comes " +
                                      found[i].second.filename().string() +
                                      ", and the numbers do not go up by one step; add what is missing, or move away "
                                      "what is none of them");
    }
    files.push_back(found[i].second);
  }
  return files;
}

}  // namespace selvage::io
