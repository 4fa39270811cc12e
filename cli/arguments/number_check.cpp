#include "cli/arguments/number_check.h"

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "io/file/text.h"

namespace selvage::cli {
namespace {

/// Of a text that is a number. strtod says so of those below the least subnormal one; the command line would go on with
/// a zero nobody asked for.
bool rounds_to_zero(const std::string& text) {
  errno = 0;
  return std::strtod(text.c_str(), nullptr) == 0 && errno == ERANGE;
}

/// Whether CLI11, which reads integers as C does, would read it to the base of 8.
bool is_octal(std::string_view text) {
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  return text.size() > 1 && text[0] == '0' && text.find_first_not_of("0123456789") == text.npos;
}

std::string refusal(const std::string& text, std::string_view what) {
  const char* const hint = is_octal(text) ? ": leave out the zeros before it" : "";
  return fmt::format("'{}' is not a {}{}", text, what, hint);
}

/// `words` are for the help and for the error.
CLI::Validator finite_number(std::function<bool(double)> is_within, const std::string& words) {
  const auto check = [is_within = std::move(is_within), words](const std::string& text) {
    double value = 0;
    const io::NumberFault fault = io::parse_number(text, value);
    if (fault == io::NumberFault::kOutOfRange && rounds_to_zero(text)) {
      return fmt::format("'{}' is too small: it would be rounded to 0", text);
    }
    if (fault == io::NumberFault::kNone && is_within(value) && !is_octal(text)) return std::string();
    return refusal(text, "number " + words);
  };
  return {check, words, ""};
}

}  // namespace

CLI::Validator number_between(double least, double most) {
  return finite_number([=](double value) { return least <= value && value <= most; },
                       fmt::format("from {} to {}", least, most));
}

CLI::Validator number_from(double least) {
  return finite_number([=](double value) { return least <= value; }, fmt::format("from {} up", least));
}

CLI::Validator number_above(double bound) {
  return finite_number([=](double value) { return bound < value; }, fmt::format("above {}", bound));
}

CLI::Validator whole_number() {
  const auto check = [](const std::string& text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc() && end == text.data() + text.size();
    return is_whole && !is_octal(text) ? std::string() : refusal(text, "whole number from 0 up");
  };
  return {check, "", ""};
}

CLI::Validator whole_between(std::int64_t least, std::int64_t most) {
  const std::string words = fmt::format("from {} to {}", least, most);
  const auto check = [=](const std::string& text) {
    const std::optional<std::int64_t> value = io::parse_integer(text);
    const bool is_within = value && least <= *value && *value <= most;
    return is_within && !is_octal(text) ? std::string() : refusal(text, "whole number " + words);
  };
  return {check, words, ""};
}

}  // namespace selvage::cli
