// The comparison of faces for one set of instructions: face_compare.cpp includes this once for each, in a namespace of
// its own. Vectors hold one number for each of the eight faces of a block; operations on them are those of the
// language, place by place, so all sets of instructions give the same answers.

using Reals = float __attribute__((vector_size(32)));
using Flags = std::int32_t __attribute__((vector_size(32)));  // 0 or -1
using Numbers = Flags;

inline Reals load(const FaceBlock::Lanes<float>& lanes) {
  Reals numbers;
  std::memcpy(&numbers, lanes.data(), sizeof numbers);
  return numbers;
}
inline Numbers load(const FaceBlock::Lanes<std::int32_t>& lanes) {
  Numbers numbers;
  std::memcpy(&numbers, lanes.data(), sizeof numbers);
  return numbers;
}
inline Reals in_all(float x) { return Reals{x, x, x, x, x, x, x, x}; }
inline Numbers in_all(std::int32_t x) { return Numbers{x, x, x, x, x, x, x, x}; }

/// Bit i: place i.
inline unsigned bits(Flags flags) {
#if defined(SELVAGE_AVX2)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(flags)));
#elif defined(__SSE2__)
  __m128 low, high;
  std::memcpy(&low, &flags, sizeof low);
  std::memcpy(&high, reinterpret_cast<const char*>(&flags) + sizeof low, sizeof high);
  return static_cast<unsigned>(_mm_movemask_ps(low) | _mm_movemask_ps(high) << 4);
#else
  unsigned mask = 0;
  for (std::size_t i = 0; i < kWidth; ++i) mask |= (flags[i] != 0 ? 1U : 0U) << i;
  return mask;
#endif
}

struct Boxes {
  std::array<Reals, 3> min, max;
};

inline Boxes load(const FaceBoxes& boxes) {
  return {{load(boxes.min[0]), load(boxes.min[1]), load(boxes.min[2])},
          {load(boxes.max[0]), load(boxes.max[1]), load(boxes.max[2])}};
}

inline Boxes boxes_of(const FaceBlock& block) {
  Boxes boxes;
  for (std::size_t k = 0; k < 3; ++k) {
    const Reals a = load(block.corners[0][k]), b = load(block.corners[1][k]), c = load(block.corners[2][k]);
    const Reals low = a < b ? a : b, high = a > b ? a : b;
    boxes.min[k] = low < c ? low : c;
    boxes.max[k] = high > c ? high : c;
  }
  return boxes;
}

inline Flags meet(const Boxes& boxes, const std::array<float, 3>& min, const std::array<float, 3>& max) {
  return (boxes.min[0] <= in_all(max[0])) & (in_all(min[0]) <= boxes.max[0]) & (boxes.min[1] <= in_all(max[1])) &
         (in_all(min[1]) <= boxes.max[1]) & (boxes.min[2] <= in_all(max[2])) & (in_all(min[2]) <= boxes.max[2]);
}

/// Where boxes overlap by more than a common boundary they did so before they were rounded.
inline Flags overlap(const Boxes& boxes, const std::array<float, 3>& min, const std::array<float, 3>& max) {
  return (boxes.min[0] < in_all(max[0])) & (in_all(min[0]) < boxes.max[0]) & (boxes.min[1] < in_all(max[1])) &
         (in_all(min[1]) < boxes.max[1]) & (boxes.min[2] < in_all(max[2])) & (in_all(min[2]) < boxes.max[2]);
}

/// Which of three corners lie strictly above and strictly below a plane.
struct Sides {
  std::array<Flags, 3> above, below;

  /// Whether all but those of `exempt` do so on one side.
  [[nodiscard]] Flags all_beyond(const std::array<Flags, 3>& exempt) const {
    return ((above[0] | exempt[0]) & (above[1] | exempt[1]) & (above[2] | exempt[2])) |
           ((below[0] | exempt[0]) & (below[1] | exempt[1]) & (below[2] | exempt[2]));
  }
  [[nodiscard]] Flags all_beyond() const { return (above[0] & above[1] & above[2]) | (below[0] & below[1] & below[2]); }
};

/// One face of a query: place i of a block.
struct Face {
  const FaceBlock& block;
  std::size_t i;

  [[nodiscard]] Reals corner(std::size_t j, std::size_t k) const { return in_all(block.corners[j][k][i]); }
};

/// Of the block's corners, for the plane of `face`.
inline Sides sides_of_corners(const FaceBlock& block, const Face& face) {
  const auto& [corners, direction, low, high, vertices] = face.block;
  const Flags is_held = load(block.high) < in_all(std::numeric_limits<float>::infinity());
  Sides sides;
  for (std::size_t j = 0; j < 3; ++j) {
    const Reals height = in_all(direction[0][face.i]) * load(block.corners[j][0]) +
                         in_all(direction[1][face.i]) * load(block.corners[j][1]) +
                         in_all(direction[2][face.i]) * load(block.corners[j][2]);
    sides.above[j] = is_held & (height > in_all(high[face.i]));
    sides.below[j] = is_held & (height < in_all(low[face.i]));
  }
  return sides;
}
/// Of the corners of `face`, for the block's planes.
inline Sides sides_of_planes(const FaceBlock& block, const Face& face) {
  const Flags is_held = in_all(face.block.high[face.i]) < in_all(std::numeric_limits<float>::infinity());
  Sides sides;
  for (std::size_t j = 0; j < 3; ++j) {
    const Reals height = load(block.direction[0]) * face.corner(j, 0) + load(block.direction[1]) * face.corner(j, 1) +
                         load(block.direction[2]) * face.corner(j, 2);
    sides.above[j] = is_held & (height > load(block.high));
    sides.below[j] = is_held & (height < load(block.low));
  }
  return sides;
}

/// What follows once boxes meet. Bit i: place i.
struct Proofs {
  unsigned overlap, apart;
};

/// Faces lie apart but for what they share if all corners of one that are not shared are strictly above the plane of
/// the other, or all are below (docs/guarantee-checker.md). A shared corner is in that plane and never counted as above
/// or below.
inline Proofs prove(const FaceBlock& block, const Face& face, Flags overlap) {
  std::array<Flags, 3> mine{}, theirs{};  // which corners are shared
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t l = 0; l < 3; ++l) {
      const Flags same = in_all(face.block.vertices[j][face.i]) == load(block.vertices[l]);
      mine[j] |= same;
      theirs[l] |= same;
    }
  }
  overlap |= mine[0] | mine[1] | mine[2];
  const Flags same_face = mine[0] & mine[1] & mine[2];
  const Flags beyond = sides_of_corners(block, face).all_beyond(theirs) | sides_of_planes(block, face).all_beyond(mine);
  return {bits(overlap), bits(overlap & beyond & ~same_face)};
}

/// What is left to do, in the order of the blocks. Every step goes through all of it without a branch but that of its
/// loop, and keeps in front what the next one is to do.
struct Work {
  /// One face of the query, or at first one block of it, against one block.
  struct Comparison {
    std::uint8_t slot;  ///< of the block among those chosen
    std::uint8_t place;
    std::uint8_t meet;
  };

  std::array<Boxes, FaceMatches::kMaxBlocks> boxes;
  std::array<Comparison, FaceMatches::kMaxBlocks * FaceQuery::kBlocks + kWidth> pairs;  // of blocks
  std::size_t pair_count = 0;
  std::array<Comparison, (FaceMatches::kMaxBlocks * FaceQuery::kBlocks + 1) * kWidth> left;
  std::size_t count = 0;
};

/// Faces of the query that meet the box of all faces of a block.
inline void begin(const FaceQuery& query, std::int64_t first, std::span<const FaceBlock> blocks,
                  std::span<const FaceBounds> bounds, std::span<const std::uint32_t> chosen, Work& work) {
  const Boxes query_bounds = load(query.bounds);
  for (std::size_t slot = 0; slot < chosen.size(); ++slot) {
    const FaceBounds& box = bounds[chosen[slot]];
    work.boxes[slot] = boxes_of(blocks[chosen[slot]]);
    const unsigned behind = (2U << std::min<std::int64_t>(chosen[slot] - first, kWidth - 1)) - 1;
    const unsigned mask = bits(meet(query_bounds, box.min, box.max)) & behind;
    for (std::size_t i = 0; i < kWidth; ++i) {
      work.pairs[work.pair_count + i] = {static_cast<std::uint8_t>(slot), kSetBits[mask][i], 0};
    }
    work.pair_count += kBitCount[mask];
  }
  for (std::size_t p = 0; p < work.pair_count; ++p) {
    const auto [slot, mine, unknown] = work.pairs[p];
    const FaceBounds& box = bounds[chosen[slot]];
    const unsigned mask = bits(meet(load(query.boxes[mine]), box.min, box.max));
    for (std::size_t i = 0; i < kWidth; ++i) {
      work.left[work.count + i] = {slot, static_cast<std::uint8_t>(kWidth * mine + kSetBits[mask][i]), 0};
    }
    work.count += kBitCount[mask];
  }
}

inline std::array<float, 3> place(const std::array<FaceBlock::Lanes<float>, 3>& x, std::size_t i) {
  return {x[0][i], x[1][i], x[2][i]};
}

/// Of them, those that meet a face of the block. Returns with how many.
inline std::int64_t keep_meeting(const FaceQuery& query, std::int64_t first, std::span<const std::uint32_t> chosen,
                                 Work& work) {
  std::int64_t pair_count = 0;
  std::size_t kept = 0;
  const std::size_t count = work.count;
  for (std::size_t w = 0; w < count; ++w) {
    const auto [slot, face, unknown] = work.left[w];
    const std::size_t mine = face / kWidth, i = face % kWidth;
    const unsigned later = chosen[slot] == first + static_cast<std::int64_t>(mine) ? 0xfeU << i : 0xffU;
    const FaceBoxes& boxes = query.boxes[mine];
    const unsigned mask = bits(meet(work.boxes[slot], place(boxes.min, i), place(boxes.max, i))) & later;
    work.left[kept] = {slot, face, static_cast<std::uint8_t>(mask)};
    kept += mask != 0 ? 1 : 0;
    pair_count += kBitCount[mask & 0xff];
  }
  work.count = kept;
  return pair_count;
}

/// Of them, those for which the plane of the face of the query does not prove everything.
inline void keep_unproved(const FaceQuery& query, std::span<const FaceBlock> blocks,
                          std::span<const std::uint32_t> chosen, Work& work) {
  std::size_t kept = 0;
  const std::size_t count = work.count;
  for (std::size_t w = 0; w < count; ++w) {
    const Work::Comparison comparison = work.left[w];
    const std::size_t mine = comparison.place / kWidth, i = comparison.place % kWidth;
    const FaceBoxes& boxes = query.boxes[mine];
    const Flags apart = overlap(work.boxes[comparison.slot], place(boxes.min, i), place(boxes.max, i)) &
                        sides_of_corners(blocks[chosen[comparison.slot]], {query.blocks[mine], i}).all_beyond();
    work.left[kept] = comparison;
    kept += (comparison.meet & ~bits(apart)) != 0 ? 1 : 0;
  }
  work.count = kept;
}

inline void compare(const FaceQuery& query, std::int64_t first, std::span<const FaceBlock> blocks,
                    std::span<const FaceBounds> bounds, std::span<const std::uint32_t> chosen, bool each,
                    FaceMatches& found) {
  Work work;
  begin(query, first, blocks, bounds, chosen, work);
  found.apart_count = keep_meeting(query, first, chosen, work);
  found.count = 0;
  if (!each) keep_unproved(query, blocks, chosen, work);
  for (std::size_t w = 0; w < work.count; ++w) {
    const auto [slot, face, meet] = work.left[w];
    const std::size_t mine = face / kWidth, i = face % kWidth;
    const FaceBoxes& boxes = query.boxes[mine];
    const Proofs proofs = prove(blocks[chosen[slot]], {query.blocks[mine], i},
                                overlap(work.boxes[slot], place(boxes.min, i), place(boxes.max, i)));
    const auto apart = static_cast<std::uint8_t>(meet & proofs.apart);
    found.matches[found.count] = {chosen[slot], face, meet, static_cast<std::uint8_t>(meet & proofs.overlap), apart};
    found.count += each || apart != meet ? 1 : 0;
    found.apart_count -= kBitCount[meet ^ apart];
  }
}
