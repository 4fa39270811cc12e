// A case that only its seed can make again: one that its first run did not survive. It has no lines but the common
// ones; `seed PROPERTY:STREAM:SEED:NUMBER` says what to draw.
#pragma once

#include "fuzz/kept/kept_case.h"

namespace selvage::fuzz {

class DrawnCase final : public KeptCase {
 public:
  static constexpr std::string_view kKind = "drawn";

  explicit DrawnCase(std::string origin) : origin_(std::move(origin)) {}
  [[nodiscard]] std::string kind() const override { return std::string(kKind); }
  [[nodiscard]] std::string promise() const override;
  [[nodiscard]] std::string body() const override { return {}; }
  /// Here and now: where the code under test crashes, so does this.
  [[nodiscard]] Retrial retry() const override;

 private:
  std::string origin_;
};

/// Throws io::Error where `origin` is no case that can be drawn.
[[nodiscard]] std::unique_ptr<KeptCase> parse_drawn_case(const std::string& origin, CaseLines& lines);

}  // namespace selvage::fuzz
