#include "cli/arguments/number_check.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace selvage::cli {
namespace {

/// strtod says so of numbers below the least subnormal one; the command line would go on with a zero nobody asked for.
bool rounds_to_zero(const std::string& text) {
  errno = 0;
  return std::strtod(text.c_str(), nullptr) == 0 && errno == ERANGE;
}

/// `words` are for the help and for the error.
CLI::Validator finite_number(std::function<bool(double)> is_within, const std::string& words) {
  const auto check = [is_within = std::move(is_within), words](const std::string& text) {
    double value = 0;
    if (rounds_to_zero(text)) return fmt::format("'{}' is too small: it would be rounded to 0", text);
    if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && is_within(value)) return std::string();
    return fmt::format("'{}' is not a number {}", text, words);
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
    if (error == std::errc() && end == text.data() + text.size()) return std::string();
    return fmt::format("'{}' is not a whole number from 0 up", text);
  };
  return {check, "", ""};
}

}  // namespace selvage::cli
