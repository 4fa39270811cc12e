#include "fuzz/case_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "io/atomic_file.h"

namespace selvage::fuzz {
namespace {

std::string_view point_names(PairKind kind) {
  switch (kind) {
    case PairKind::kVf:
      return "pabc";
    case PairKind::kEe:
      return "abcd";
    case PairKind::kSelf:
      break;
  }
  return "pab";
}

std::string hex(double x) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), std::abs(x), std::chars_format::hex).ptr;
  return (std::signbit(x) ? "-0x" : "0x") + std::string(text.data(), end);
}

std::string format_point(const Vec3& point) { return hex(point.x()) + " " + hex(point.y()) + " " + hex(point.z()); }

/// Reads one line after another, and within a line one word after another.
class Lines {
 public:
  Lines(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  /// The next line that is not empty; fails at the end of the text.
  void advance() {
    line_ = {};
    while (word_start(line_) == line_.size()) {
      if (rest_.empty()) fail("the case ends too early");
      take_line();
    }
  }
  [[nodiscard]] bool only_blank_left() {
    while (!rest_.empty()) {
      take_line();
      if (word_start(line_) != line_.size()) return false;
    }
    return true;
  }
  [[nodiscard]] std::string_view word() {
    line_.remove_prefix(word_start(line_));
    if (line_.empty()) fail("a word is missing");
    const std::size_t length = std::min(line_.find_first_of(kBlank), line_.size());
    const std::string_view found = line_.substr(0, length);
    line_.remove_prefix(length);
    return found;
  }
  void expect_word(std::string_view wanted) {
    if (word() != wanted) fail("expected '" + std::string(wanted) + "'");
  }
  void expect_end_of_line() {
    if (word_start(line_) != line_.size()) fail("unexpected '" + std::string(word()) + "'");
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw io::Error(io::ErrorKind::kBadInput, name_ + ":" + std::to_string(number_) + ": " + what);
  }

 private:
  static constexpr std::string_view kBlank = " \t\r";
  static std::size_t word_start(std::string_view line) { return std::min(line.find_first_not_of(kBlank), line.size()); }
  void take_line() {
    const std::size_t length = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, length);
    line_ = line_.substr(0, line_.find('#'));
    rest_.remove_prefix(std::min(length + 1, rest_.size()));
    ++number_;
  }

  std::string_view rest_, line_;
  const std::string& name_;
  int number_ = 0;
};

double parse_double(Lines& lines, std::string_view word) {
  std::string_view digits = word;
  const bool negative = digits.starts_with('-');
  if (negative) digits.remove_prefix(1);
  const bool is_hex = digits.starts_with("0x");
  if (is_hex) digits.remove_prefix(2);
  double x = 0;
  const auto format = is_hex ? std::chars_format::hex : std::chars_format::general;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x, format);
  if (error != std::errc() || end != digits.data() + digits.size() || digits.starts_with('-') || !std::isfinite(x)) {
    lines.fail("'" + std::string(word) + "' is not a finite number");
  }
  return negative ? -x : x;
}

std::string_view option_value(Lines& lines, std::string_view key) {
  const std::string_view word = lines.word();
  if (!word.starts_with(key) || word.size() <= key.size() || word[key.size()] != '=') {
    lines.fail("expected '" + std::string(key) + "=...'");
  }
  return word.substr(key.size() + 1);
}

std::int32_t parse_count(Lines& lines, std::string_view word) {
  std::int32_t count = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
  if (error != std::errc() || end != word.data() + word.size() || count < 1) {
    lines.fail("'" + std::string(word) + "' is not a positive count");
  }
  return count;
}

PairKind parse_kind(Lines& lines, std::string_view word) {
  const auto* kind = std::find_if(kPairKinds.begin(), kPairKinds.end(), [&](PairKind k) { return name_of(k) == word; });
  if (kind == kPairKinds.end()) lines.fail("the kind of pair is vf, ee or self, not '" + std::string(word) + "'");
  return *kind;
}

Vec3 parse_point(Lines& lines) {
  Vec3 point;
  for (double& coordinate : point) coordinate = parse_double(lines, lines.word());
  return point;
}

}  // namespace

std::string format_case(const Case& kept) {
  const MotionQuery& query = kept.query;
  std::string text = "selvage-case 1 " + std::string(name_of(query.kind)) + "\n";
  text += "seed " + kept.seed + "\n";
  text += "options tolerance=" + hex(query.options.tolerance) +
          " max_intervals=" + std::to_string(query.options.max_intervals) + "\n";
  const std::string_view names = point_names(query.kind);
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += std::string(1, names[i]) + " " + format_point(query.x_t0[i]) + "  " + format_point(query.x_t1[i]) + "\n";
  }
  return text + (kept.touches ? "expect touches\n" : "expect apart\n");
}

Case parse_case(std::string_view text, const std::string& name) {
  Lines lines(text, name);
  Case kept;
  lines.advance();
  lines.expect_word("selvage-case");
  lines.expect_word("1");
  kept.query.kind = parse_kind(lines, lines.word());
  lines.expect_end_of_line();
  lines.advance();
  lines.expect_word("seed");
  kept.seed = lines.word();
  lines.expect_end_of_line();
  lines.advance();
  lines.expect_word("options");
  kept.query.options.tolerance = parse_double(lines, option_value(lines, "tolerance"));
  kept.query.options.max_intervals = parse_count(lines, option_value(lines, "max_intervals"));
  lines.expect_end_of_line();
  const std::string_view names = point_names(kept.query.kind);
  for (std::size_t i = 0; i < names.size(); ++i) {
    lines.advance();
    lines.expect_word(names.substr(i, 1));
    kept.query.x_t0[i] = parse_point(lines);
    kept.query.x_t1[i] = parse_point(lines);
    lines.expect_end_of_line();
  }
  if (kept.query.kind == PairKind::kSelf) {
    kept.query.x_t0[3] = kept.query.x_t0[0];
    kept.query.x_t1[3] = kept.query.x_t1[0];
  }
  lines.advance();
  lines.expect_word("expect");
  const std::string_view answer = lines.word();
  if (answer != "touches" && answer != "apart") lines.fail("the answer is 'touches' or 'apart'");
  kept.touches = answer == "touches";
  lines.expect_end_of_line();
  if (!lines.only_blank_left()) lines.fail("nothing may follow 'expect'");
  return kept;
}

Case read_case(const std::filesystem::path& file) { return parse_case(io::read_file(file, 1 << 16), file.string()); }

std::vector<std::filesystem::path> case_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  std::filesystem::directory_iterator entries(folder, error);
  if (error) throw io::Error(io::ErrorKind::kFile, folder.string() + ": " + error.message());
  for (const auto& entry : entries) {
    if (entry.path().extension() == ".case") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace selvage::fuzz
