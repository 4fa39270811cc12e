#include "sim/base/vertex_faces.h"

#include <gtest/gtest.h>

namespace selvage::sim {

TEST(VertexFaces, AreThoseThatHoldTheVertex) {
  const Mesh mesh = make_mesh(6, Faces{{0, 1, 2}, {2, 1, 3}, {1, 2, 0}, {3, 4, 0}});  // one of them twice
  const VertexFaces faces(mesh);
  const std::vector<std::vector<FaceId>> expected{{0, 2, 3}, {0, 1, 2}, {0, 1, 2}, {1, 3}, {3}, {}};
  for (VertexId v = 0; v < 6; ++v) {
    const auto found = faces.of(v);
    EXPECT_EQ(std::vector<FaceId>(found.begin(), found.end()), expected[static_cast<std::size_t>(v)]) << v;
  }
}

}  // namespace selvage::sim
