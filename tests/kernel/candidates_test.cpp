#include "kernel/candidates.h"

#include <gtest/gtest.h>

namespace selvage {

TEST(PairVertices, AreInQueryOrder) {
  Faces F(2, 3);
  F << 4, 0, 1, 2, 1, 3;
  const Mesh mesh = make_mesh(5, F);
  using Four = std::array<VertexId, 4>;
  EXPECT_EQ(pair_vertices(mesh, PairKind::kVf, 2, 0), (Four{2, 4, 0, 1}));
  EXPECT_EQ(pair_vertices(mesh, PairKind::kEe, 0, 3), (Four{0, 1, 2, 3}));  // edges 01, 12, 13, 23, 04, 14
  EXPECT_EQ(pair_vertices(mesh, PairKind::kSelf, 4, 0), (Four{4, 0, 1, 4}));
  EXPECT_EQ(pair_vertices(mesh, PairKind::kSelf, 1, 1), (Four{1, 3, 2, 1}));
}

}  // namespace selvage
