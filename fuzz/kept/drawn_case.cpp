#include "fuzz/kept/drawn_case.h"

#include <charconv>
#include <utility>

namespace selvage::fuzz {
namespace {

class DrawnCase final : public KeptCase {
 public:
  explicit DrawnCase(Redrawn redrawn) : redrawn_(std::move(redrawn)) {}
  [[nodiscard]] std::string kind() const override { return std::string(kDrawn); }
  [[nodiscard]] std::string promise() const override { return redrawn_.promise; }
  [[nodiscard]] std::string body() const override { return {}; }
  [[nodiscard]] Retrial retry() const override { return redrawn_.retry(); }

 private:
  Redrawn redrawn_;
};

template <typename Number>
bool parse_number(std::string_view word, Number& x) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

/// "PROPERTY:STREAM:SEED:NUMBER", as case_origin() writes it.
std::optional<CaseOrigin> parse_origin(const std::string& word) {
  std::vector<std::string> parts(1);
  for (const char c : word) {
    if (c == ':') {
      parts.emplace_back();
    } else {
      parts.back() += c == '/' ? ' ' : c;
    }
  }
  CaseOrigin origin;
  if (parts.size() != 4 || !parse_number(parts[2], origin.seed) || !parse_number(parts[3], origin.number)) return {};
  origin.property = parts[0];
  origin.stream = parts[1];
  return origin;
}

}  // namespace

std::string drawn_text(const std::string& origin, const std::string& failure) {
  return kept_text(DrawnCase({}), origin, failure);
}

std::unique_ptr<KeptCase> parse_drawn_case(const std::string& origin, const Redraw& redraw, CaseLines& lines) {
  const std::optional<CaseOrigin> parts = parse_origin(origin);
  std::optional<Redrawn> redrawn;
  if (parts) redrawn = redraw(*parts);
  if (!redrawn) lines.fail("seed: '" + origin + "' is not PROPERTY:STREAM:SEED:NUMBER of a known property");
  if (!lines.only_blank_left()) lines.fail("nothing may follow 'failure'; remove it");
  return std::make_unique<DrawnCase>(*std::move(redrawn));
}

}  // namespace selvage::fuzz
