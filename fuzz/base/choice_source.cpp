#include "fuzz/base/choice_source.h"

#include "kernel/assert.h"

namespace selvage::fuzz {
namespace {

// splitmix64 (Steele, Lea, Flood 2014): a counter with a bijective finaliser, so every seed gives a full-period stream.
constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15;
constexpr std::uint64_t finalise(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

constexpr int byte_count(std::uint32_t k) { return k <= 0x100 ? 1 : k <= 0x10000 ? 2 : 4; }

}  // namespace

std::uint64_t mix(std::uint64_t a, std::uint64_t b) { return finalise(finalise(a + kGolden) ^ (b * kGolden)); }

ChoiceSource ChoiceSource::from_seed(std::uint64_t seed) {
  ChoiceSource source(Feed::kSeed);
  source.state_ = finalise(seed + kGolden);  // so that neighbouring seeds are not shifted copies of one stream
  return source;
}

ChoiceSource ChoiceSource::from_words(std::span<const std::uint32_t> words) {
  ChoiceSource source(Feed::kWords);
  source.words_ = words;
  return source;
}

ChoiceSource ChoiceSource::from_bytes(std::span<const std::uint8_t> bytes) {
  ChoiceSource source(Feed::kBytes);
  source.bytes_ = bytes;
  return source;
}

std::uint32_t ChoiceSource::next_word(std::uint32_t k) {
  switch (feed_) {
    case Feed::kSeed:
      state_ += kGolden;
      return static_cast<std::uint32_t>(finalise(state_) >> 32);
    case Feed::kWords:
      return next_ < words_.size() ? words_[next_++] : 0;
    case Feed::kBytes:
      break;
  }
  std::uint32_t word = 0;
  for (int i = 0; i < byte_count(k) && next_ < bytes_.size(); ++i) word = word << 8 | bytes_[next_++];
  return word;
}

void ChoiceSource::record(std::uint32_t answer, std::uint32_t k) {
  for (int i = byte_count(k) - 1; i >= 0; --i) record_->push_back(static_cast<std::uint8_t>(answer >> (8 * i)));
}

std::uint32_t ChoiceSource::n(std::uint32_t k) {
  SELVAGE_ASSERT(k >= 1);
  if (k == 1) return 0;
  const std::uint32_t answer = next_word(k) % k;  // keeps small words small; the bias, k/2^32, does not matter
  if (record_ != nullptr) record(answer, k);
  if (words_record_ != nullptr) words_record_->push_back(answer);
  return answer;
}

std::int64_t ChoiceSource::zigzag(std::uint32_t radius) {
  SELVAGE_ASSERT(radius <= 0x7fffffffU);
  const std::int64_t i = n(2 * radius + 1);
  return i % 2 == 0 ? -i / 2 : (i + 1) / 2;
}

double ChoiceSource::unit_real() {
  const std::uint64_t high = n(1U << 26);
  const std::uint64_t low = n(1U << 27);
  return static_cast<double>(high << 27 | low) * 0x1p-53;
}

double ChoiceSource::signed_real() {
  const double magnitude = unit_real();
  return coin() ? -magnitude : magnitude;
}

}  // namespace selvage::fuzz
