#include "fuzz/kept/drawn_case.h"

#include <algorithm>
#include <charconv>
#include <exception>
#include <optional>

#include "fuzz/base/deaths.h"
#include "fuzz/run/worker.h"

namespace selvage::fuzz {
namespace {

struct Draw {
  std::unique_ptr<Property> property;
  const Stream* stream = nullptr;
  std::uint64_t seed = 0;
  std::int64_t number = 0;
};

template <typename Number>
bool parse_number(std::string_view word, Number& x) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

/// "PROPERTY:STREAM:SEED:NUMBER", as case_origin() writes it.
std::optional<Draw> draw_of(const std::string& origin) {
  std::vector<std::string> parts(1);
  for (const char c : origin) {
    if (c == ':') {
      parts.emplace_back();
    } else {
      parts.back() += c == '/' ? ' ' : c;
    }
  }
  Draw draw;
  if (parts.size() != 4 || !parse_number(parts[2], draw.seed) || !parse_number(parts[3], draw.number)) return {};
  for (auto& property : all_properties()) {
    if (property->name() != parts[0]) continue;
    const auto stream = std::ranges::find(property->streams(), parts[1], &Stream::name);
    if (stream == property->streams().end()) return {};
    draw.stream = &*stream;
    draw.property = std::move(property);
    return draw;
  }
  return {};
}

}  // namespace

std::string DrawnCase::promise() const { return draw_of(origin_)->property->promise(); }

Retrial DrawnCase::retry() const {
  const std::optional<Draw> draw = draw_of(origin_);
  try {
    const OneCase run = run_case(*draw->property, *draw->stream, draw->seed, draw->number, kCaseSeconds);
    return {run.outcome.failure, {"drawn again from its seed, in a process of its own"}, {}};
  } catch (const std::exception& error) {
    return {kThrew, {error.what()}, {}};
  }
}

std::unique_ptr<KeptCase> parse_drawn_case(const std::string& origin, CaseLines& lines) {
  if (!draw_of(origin)) lines.fail("seed: '" + origin + "' is not PROPERTY:STREAM:SEED:NUMBER of a known property");
  if (!lines.only_blank_left()) lines.fail("nothing may follow 'failure'; remove it");
  return std::make_unique<DrawnCase>(origin);
}

}  // namespace selvage::fuzz
