// One decoder of choices for every engine that makes cases: a seeded generator (bulk campaigns), words (RapidCheck) or
// bytes (libFuzzer) answer the same questions, so all engines share the generators.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace selvage::fuzz {

/// Answers "which of k?" again and again. The answer 0 is always the simplest one, and an exhausted source answers 0:
/// a shorter or smaller source means a simpler case, which is what lets RapidCheck and libFuzzer shrink.
/// Does not own what it reads. Copying forks the source.
/// One question a statement, or several in one braced list: in the arguments of a call and the operands of an operator
/// each compiler asks in an order of its own, and a source would mean another case to each.
class ChoiceSource {
 public:
  /// Endless; the same seed gives the same answers on every machine.
  static ChoiceSource from_seed(std::uint64_t seed);
  static ChoiceSource from_words(std::span<const std::uint32_t> words);
  /// Takes as few bytes an answer as k needs: 1, 2 or 4.
  static ChoiceSource from_bytes(std::span<const std::uint8_t> bytes);
  /// From now on appends to `bytes`, for each answer, what makes from_bytes() answer the same: so the case of any feed
  /// becomes an input of the byte engines. A copy goes on appending; ask one of the two only.
  void record_to(std::vector<std::uint8_t>& bytes) { record_ = &bytes; }
  /// The same for from_words().
  void record_to(std::vector<std::uint32_t>& words) { words_record_ = &words; }

  /// 0 .. k-1. REQUIRES k >= 1.
  std::uint32_t n(std::uint32_t k);

  bool coin() { return n(2) == 1; }
  /// True with probability 1/k; false is the simple answer.
  bool one_in(std::uint32_t k) { return n(k) + 1 == k && k > 1; }
  /// 0, 1, -1, 2, -2, ... up to +-radius: shrinks towards 0, not towards -radius.
  std::int64_t zigzag(std::uint32_t radius);
  /// first .. last, inclusive; the simple answer is `first`.
  int range(int first, int last) { return first + static_cast<int>(n(static_cast<std::uint32_t>(last - first) + 1)); }
  /// Uniform in [0, 1), a multiple of 2^-53.
  double unit_real();
  /// Uniform in (-1, 1); the sign is a choice of its own.
  double signed_real();

 private:
  enum class Feed : std::uint8_t { kSeed, kWords, kBytes };
  explicit ChoiceSource(Feed feed) : feed_(feed) {}
  std::uint32_t next_word(std::uint32_t k);
  void record(std::uint32_t answer, std::uint32_t k);

  Feed feed_;
  std::uint64_t state_ = 0;
  std::span<const std::uint32_t> words_;
  std::span<const std::uint8_t> bytes_;
  std::size_t next_ = 0;
  std::vector<std::uint8_t>* record_ = nullptr;
  std::vector<std::uint32_t>* words_record_ = nullptr;
};

/// A well mixed 64-bit hash of two numbers (splitmix64): seeds of cases from (campaign seed, case number).
[[nodiscard]] std::uint64_t mix(std::uint64_t a, std::uint64_t b);

}  // namespace selvage::fuzz
