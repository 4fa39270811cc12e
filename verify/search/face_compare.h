// The first filter of the frame check: faces against eight others at once, in single precision with proved bounds.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "verify/search/face_block.h"

namespace selvage::verify {

/// Up to eight blocks that lie side by side in their tree, which are compared with many others.
struct FaceQuery {
  static constexpr std::size_t kBlocks = 8;

  std::span<const FaceBlock> blocks;
  FaceBoxes bounds;                      ///< of the blocks
  std::array<FaceBoxes, kBlocks> boxes;  ///< of their faces

  FaceQuery(std::span<const FaceBlock> of, std::span<const FaceBounds> bounds_of);
};

/// What is known about a face of a query and the eight of a block; bit i is about the face at place i of the block.
struct FaceMatch {
  std::uint32_t block;
  std::uint8_t place;  ///< of the face in the query, eight to a block
  /// The stored boxes have a point in common: so do all whose exact boxes have.
  std::uint8_t meet;
  /// Of these: proved that the exact boxes have.
  std::uint8_t overlap;
  /// Of these: proved that the faces have none but corners shared by index.
  std::uint8_t apart;
};

struct FaceMatches {
  /// Blocks that are compared in one go: the loops over them and their faces have few branches that cannot be
  /// predicted, and what they read stays in the first cache.
  static constexpr std::size_t kMaxBlocks = 32;

  std::array<FaceMatch, kMaxBlocks * FaceQuery::kBlocks * FaceBlock::kWidth> matches;
  std::size_t count = 0;
  std::int64_t apart_count = 0;  ///< pairs that are proved apart, those in `matches` included
};

/// Compares the faces of `query` with those of blocks[chosen[0]], ..., at most kMaxBlocks of them. `first`: which of
/// `blocks` is the first of the query again; then only faces behind the one of the query count, so that every pair
/// counts once. kOtherTree: none is. Found are, by block and place, the matches with a pair that may meet and is not
/// proved apart; if `each`, all with a pair that meets.
using CompareFaces = void (*)(const FaceQuery& query, std::int64_t first, std::span<const FaceBlock> blocks,
                              std::span<const FaceBounds> bounds, std::span<const std::uint32_t> chosen, bool each,
                              FaceMatches& found);
inline constexpr std::int64_t kOtherTree = -static_cast<std::int64_t>(FaceQuery::kBlocks);  // before them all

struct FaceComparer {
  const char* instructions;
  CompareFaces compare;
};
/// The same code for every set of instructions that this processor has, the best one last. All give the same answers.
[[nodiscard]] std::span<const FaceComparer> face_comparers();

}  // namespace selvage::verify
