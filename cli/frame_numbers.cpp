#include "cli/frame_numbers.h"

#include <charconv>
#include <cstdint>

#include <fmt/format.h>

namespace selvage::cli {
namespace {

struct NumberedName {
  std::string before, after;  ///< with the folder and the extension
  std::int64_t number = 0;
};

std::optional<NumberedName> numbered(const std::filesystem::path& file) {
  constexpr const char* kDigits = "0123456789";
  const std::string name = file.string(), stem = file.stem().string();
  const std::size_t last = stem.find_last_of(kDigits);
  if (last == stem.npos) return std::nullopt;
  const std::size_t before = stem.find_last_not_of(kDigits, last), first = before == stem.npos ? 0 : before + 1;
  const std::size_t folder = name.size() - file.filename().string().size();
  NumberedName result{name.substr(0, folder + first), name.substr(folder + last + 1)};
  const auto [end, error] = std::from_chars(stem.data() + first, stem.data() + last + 1, result.number);
  if (error != std::errc() || end != stem.data() + last + 1) return std::nullopt;
  return result;
}

}  // namespace

std::optional<std::string> jump_in_numbers(const std::vector<std::filesystem::path>& files) {
  std::vector<NumberedName> names;
  for (const auto& file : files) {
    const auto name = numbered(file);
    if (!name) return std::nullopt;
    names.push_back(*name);
    if (names.front().before != name->before || names.front().after != name->after) return std::nullopt;
  }
  std::int64_t step = 1;
  for (std::size_t i = 1; i < names.size(); ++i) {
    const std::int64_t difference = names[i].number - names[i - 1].number;
    if (i == 1 && difference > 0) step = difference;
    if (difference == step) continue;
    return fmt::format("{} comes right after {}; what is missing between is not checked", files[i].string(),
                       files[i - 1].string());
  }
  return std::nullopt;
}

}  // namespace selvage::cli
