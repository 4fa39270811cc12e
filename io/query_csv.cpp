#include "io/query_csv.h"

#include <optional>
#include <string>

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/fp_guard.h"
#include "io/file/rational.h"
#include "io/file/text.h"

namespace selvage::io {
namespace {

/// The columns of one line; at most 8, which is one too many.
std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> columns;
  while (columns.size() < 8) {
    const std::size_t comma = line.find(',');
    columns.push_back(trimmed(line.substr(0, comma)));
    if (comma == line.npos) break;
    line.remove_prefix(comma + 1);
  }
  return columns;
}

double parse_coordinate(const LineReader& lines, std::string_view numerator, std::string_view denominator) {
  double value = 0;
  const RationalFault fault = parse_rational(numerator, denominator, value);
  if (fault == RationalFault::kNone) return value;
  const std::string rational = in_quotes(numerator) + " / " + in_quotes(denominator);
  if (fault == RationalFault::kZeroDenominator) lines.fail(rational + " has the denominator zero; correct it");
  if (fault == RationalFault::kSyntax) lines.fail(rational + " is no integer over a positive integer; correct it");
  if (fault == RationalFault::kManyDigits) {
    lines.fail(rational + " has a number of more than " + std::to_string(kMaxDigits) +
               " digits; write it in lowest terms");
  }
  lines.fail(rational + " is not exactly a double; write the rational of the stored double");
}

std::optional<bool> parse_truth(const LineReader& lines, const std::vector<std::string_view>& columns) {
  if (columns.size() == 6) return std::nullopt;
  if (columns[6] != "0" && columns[6] != "1") lines.fail("the truth is " + in_quotes(columns[6]) + "; write 0 or 1");
  return columns[6] == "1";
}

/// Whether more digits could make another power of two of `digits`: those are the denominators of doubles in lowest
/// terms. A file of the public sets has no last line break, so that one without it is read where it can only be whole.
bool begins_power_of_two(std::string_view digits) {
  constexpr int kLargestExponent = 1074;  // the smallest double is 2^-1074
  std::string power = "1";
  for (int exponent = 1; exponent <= kLargestExponent; ++exponent) {
    int carry = 0;
    for (auto digit = power.rbegin(); digit != power.rend(); ++digit) {
      const int doubled = 2 * (*digit - '0') + carry;
      *digit = static_cast<char>('0' + doubled % 10);
      carry = doubled / 10;
    }
    if (carry > 0) power.insert(power.begin(), '1');
    if (power.size() > digits.size() && power.starts_with(digits)) return true;
  }
  return false;
}

/// A truth is one digit, of which nothing can be cut but the whole.
bool may_be_cut(std::string_view bytes, const std::vector<std::string_view>& columns) {
  const std::string_view last = columns.back();
  return columns.size() == 6 && last.data() + last.size() == bytes.data() + bytes.size() && begins_power_of_two(last);
}

}  // namespace

std::vector<CcdQuery> parse_query_csv(std::string_view bytes, const std::string& name) {
  const FpGuard guard;
  std::vector<CcdQuery> queries;
  std::size_t row = 0, column_count = 0;
  LineReader lines(bytes, name);
  while (const std::optional<std::string_view> line = lines.next()) {
    const std::vector<std::string_view> columns = split(*line);
    if (column_count == 0) column_count = columns.size();
    if (columns.size() != column_count || column_count < 6 || column_count > 7) {
      lines.fail("a row has three rationals (six columns) and maybe the truth, the same in all rows; correct it");
    }
    if (may_be_cut(bytes, columns)) lines.fail(kMayBeCut);
    const std::optional<bool> truth = parse_truth(lines, columns);
    if (row == 0) queries.push_back({.points = {}, .truth = truth});
    if (queries.back().truth != truth)
      lines.fail("the truth differs from the one above it in the same query; correct it");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      queries.back().points[row][axis] = parse_coordinate(lines, columns[2 * axis], columns[2 * axis + 1]);
    }
    row = (row + 1) % kRowsPerQuery;
  }
  if (queries.empty()) bad_input(name, "no query; is this a query file?");
  if (row != 0) lines.fail("the last query has " + std::to_string(row) + " of its 8 rows; the file is cut short");
  return queries;
}

std::vector<CcdQuery> read_query_csv(const std::filesystem::path& file) {
  return parse_query_csv(read_file(file), file.string());
}

}  // namespace selvage::io
