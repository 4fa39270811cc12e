// What coverage-guided engines run: one function of bytes for each parser and for each level of the campaigns.
// libFuzzer, AFL++ and the replay of the committed corpus call the same ones.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace selvage::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// What one input came to.
struct TargetResult {
  std::vector<std::string> shown;  ///< words for what happened: "accepted", "touches"
  std::string failure;             ///< the broken promise in a word, or empty
};

class FuzzTarget {
 public:
  FuzzTarget(std::string name, std::vector<std::string> must_show)
      : name_(std::move(name)), must_show_(std::move(must_show)) {}
  virtual ~FuzzTarget() = default;
  FuzzTarget(const FuzzTarget&) = delete;
  FuzzTarget& operator=(const FuzzTarget&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// A corpus that does not show each of these at least once tests nothing.
  [[nodiscard]] const std::vector<std::string>& must_show() const { return must_show_; }

  /// Once in a process, before the first input: what would be charged to it otherwise.
  virtual void prepare() {}
  /// Any bytes are an input. What the code under test throws passes through: it is a defect.
  [[nodiscard]] virtual TargetResult run(Bytes input) = 0;
  /// A failing input as a file for `selvage replay` or for people, made simpler; empty where the input is that file.
  [[nodiscard]] virtual std::string kept(Bytes input, const std::string& failure) = 0;
  /// Inputs to start from.
  [[nodiscard]] virtual std::vector<std::string> seeds() = 0;

 private:
  std::string name_;
  std::vector<std::string> must_show_;
};

/// Every target, in a fixed order: one for each of file_formats(), then `query`, `broad`, `step` and `subdivision`.
[[nodiscard]] std::vector<std::unique_ptr<FuzzTarget>> fuzz_targets();
/// The one of this name; throws std::invalid_argument.
[[nodiscard]] std::unique_ptr<FuzzTarget> fuzz_target(std::string_view name);

}  // namespace selvage::fuzz
