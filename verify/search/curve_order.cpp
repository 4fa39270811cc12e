#include "verify/search/curve_order.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <tbb/blocked_range.h>

#include "verify/arithmetic/fp_guard.h"
#include "verify/search/own_tasks.h"

namespace selvage::verify {
namespace {

constexpr int kBits = 16;  // of a coordinate: 2^48 places, so that a scene may be 65,536 times its smallest cluster

constexpr unsigned rotated_left(unsigned octant, unsigned by) { return (octant << by | octant >> (3 - by)) & 7; }
constexpr unsigned gray_code(unsigned x) { return x ^ x >> 1; }

/// The curve enters a cube at the corner `entry` and leaves it along `axis`; where in it an octant comes, and how the
/// curve passes through that octant. Source: Hamilton, "Compact Hilbert Indices", Dalhousie CS-2006-07, algorithm 2.
struct Passage {
  unsigned place, entry, axis;
};
constexpr Passage passage(unsigned entry, unsigned axis, unsigned octant) {
  const unsigned turn = (axis + 1) % 3;
  const unsigned gray = rotated_left(octant ^ entry, (3 - turn) % 3);
  const unsigned place = gray ^ gray >> 1 ^ gray >> 2;
  if (place == 0) return {0, entry, turn};
  const unsigned inner_entry = gray_code(2 * ((place - 1) / 2));
  const auto inner_axis = static_cast<unsigned>(std::countr_one(place % 2 == 0 ? place - 1 : place)) % 3;
  return {place, entry ^ rotated_left(inner_entry, turn), (axis + inner_axis + 1) % 3};
}

/// Two such steps at once, from a state (3 entry + axis) and six bits of a point: six bits of the code, and above them
/// the state behind.
constexpr auto kTwoSteps = [] {
  std::array<std::array<std::uint16_t, 64>, 24> steps{};
  for (unsigned state = 0; state < 24; ++state) {
    for (unsigned octants = 0; octants < 64; ++octants) {
      const Passage outer = passage(state / 3, state % 3, octants / 8);
      const Passage inner = passage(outer.entry, outer.axis, octants % 8);
      steps[state][octants] =
          static_cast<std::uint16_t>((3 * inner.entry + inner.axis) << 6 | outer.place << 3 | inner.place);
    }
  }
  return steps;
}();

/// The lowest 21 bits of x, two zeros after each.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

/// The upper bits of a code, and below them the number of its element: half the memory of both in full.
constexpr int kIndexBits = 31, kDroppedBits = 3 * kBits + kIndexBits - 64;

std::size_t index_of(std::uint64_t key) { return key & ((std::uint64_t{1} << kIndexBits) - 1); }
std::uint64_t upper_code(std::uint64_t key) { return key >> kIndexBits; }

/// Sorts by upper_code; keeps the order of equal ones. Digit by digit, lowest first: a third of the time of comparing.
void sort_by_upper_code(std::vector<std::uint64_t>& keys) {
  constexpr std::size_t kDigits = 3, kDigitBits = 11;
  static_assert(kDigits * kDigitBits + kIndexBits == 64);
  const auto digit_of = [](std::uint64_t key, std::size_t digit) {
    return key >> (kIndexBits + kDigitBits * digit) & ((1U << kDigitBits) - 1);
  };
  std::vector<std::array<std::size_t, kDigits>> begins(std::size_t{1} << kDigitBits);
  for (const std::uint64_t key : keys) {
    for (std::size_t digit = 0; digit < kDigits; ++digit) ++begins[digit_of(key, digit)][digit];
  }
  std::array<std::size_t, kDigits> begin{};
  for (auto& counts : begins) {
    for (std::size_t digit = 0; digit < kDigits; ++digit) begin[digit] += std::exchange(counts[digit], begin[digit]);
  }
  std::vector<std::uint64_t> sorted(keys.size());
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    for (const std::uint64_t key : keys) sorted[begins[digit_of(key, digit)][digit]++] = key;
    keys.swap(sorted);
  }
}

}  // namespace

std::uint64_t hilbert_code(const std::array<std::int32_t, 3>& point) {
  std::uint64_t octants = 0;  // three bits a level
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t from_zero = static_cast<std::uint32_t>(point[k]) + (std::uint32_t{1} << 31);
    octants |= spread(from_zero >> (32 - kBits)) << k;
  }
  std::uint64_t code = 0;
  unsigned state = 0;
  for (int shift = 3 * kBits - 6; shift >= 0; shift -= 6) {
    const unsigned step = kTwoSteps[state][octants >> shift & 63];
    code = code << 6 | (step & 63);
    state = step >> 6;
  }
  return code;
}

std::vector<std::int32_t> order_by_code(std::size_t count, const std::function<std::uint64_t(std::size_t)>& code) {
  std::vector<std::uint64_t> keys(count);
  own_parallel_for(tbb::blocked_range<std::size_t>(0, count), [&](const auto& range) {
    const FpGuard guard;
    for (std::size_t i = range.begin(); i < range.end(); ++i) keys[i] = code(i) >> kDroppedBits << kIndexBits | i;
  });
  sort_by_upper_code(keys);
  const FpGuard guard;
  for (auto begin = keys.begin(); begin != keys.end();) {  // few but where a cluster is small beside the scene
    const auto end =
        std::find_if(begin, keys.end(), [&](std::uint64_t key) { return upper_code(key) != upper_code(*begin); });
    constexpr int kFew = 8;  // a block's worth, whatever their order
    if (end - begin > kFew) {
      std::vector<std::pair<std::uint64_t, std::uint64_t>> full;
      for (auto key = begin; key != end; ++key) full.emplace_back(code(index_of(*key)), *key);
      std::sort(full.begin(), full.end());
      std::transform(full.begin(), full.end(), begin, [](const auto& of) { return of.second; });
    }
    begin = end;
  }
  std::vector<std::int32_t> order(count);
  std::transform(keys.begin(), keys.end(), order.begin(),
                 [](std::uint64_t key) { return static_cast<std::int32_t>(index_of(key)); });
  return order;
}

}  // namespace selvage::verify
