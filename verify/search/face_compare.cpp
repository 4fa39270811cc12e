#include "verify/search/face_compare.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "verify/search/set_bits.h"

namespace selvage::verify {
namespace {

constexpr std::size_t kWidth = FaceBlock::kWidth;
static_assert(kWidth == FaceQuery::kBlocks);

FaceBoxes boxes_of(const FaceBlock& block) {
  FaceBoxes boxes;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < kWidth; ++i) {
      const auto [min, max] = std::minmax({block.corners[0][k][i], block.corners[1][k][i], block.corners[2][k][i]});
      boxes.min[k][i] = min;
      boxes.max[k][i] = max;
    }
  }
  return boxes;
}

namespace baseline {
#include "verify/search/face_compare-inl.h"
}

#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
#define SELVAGE_AVX2
#include "verify/search/face_compare-inl.h"
#undef SELVAGE_AVX2
}  // namespace avx2
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

}  // namespace

FaceQuery::FaceQuery(std::span<const FaceBlock> of, std::span<const FaceBounds> bounds_of) : blocks(of) {
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const FaceBounds box = b < bounds_of.size() ? bounds_of[b] : FaceBounds();
    for (std::size_t k = 0; k < 3; ++k) {
      bounds.min[k][b] = box.min[k];
      bounds.max[k][b] = box.max[k];
    }
    if (b < blocks.size()) boxes[b] = boxes_of(blocks[b]);
  }
}

std::span<const FaceComparer> face_comparers() {
  static const std::vector<FaceComparer> comparers = [] {
    std::vector<FaceComparer> known = {{"baseline", baseline::compare}};
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2")) known.push_back({"AVX2", avx2::compare});
#endif
    return known;
  }();
  return comparers;
}

}  // namespace selvage::verify
