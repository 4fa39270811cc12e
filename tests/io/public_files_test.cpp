// The public files, read whole: figures as published with them.
#include <algorithm>
#include <cmath>
#include <ostream>

#include <gtest/gtest.h>

#include "io/mesh_reader.h"
#include "io/query_csv.h"
#include "io/sequence.h"
#include "tests/public_data.h"

namespace selvage::io {
namespace {

class PublicFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto folder = selvage::testing::public_data();
    if (!folder) GTEST_SKIP() << "no public data";
    data_ = *folder;
  }
  std::filesystem::path data_;
};

TEST_F(PublicFiles, BigEndianFloatFramesOfClothBall) {
  const std::filesystem::path frames = data_ / "ccd/scalable-ccd/cloth-ball/frames";
  const auto reader = open_sequence({frames / "cloth_ball92.ply", frames / "cloth_ball93.ply"});
  EXPECT_TRUE(reader->same_faces_as_previous(1));
  EXPECT_EQ(reader->precision(), Precision::kFloat32);
  for (std::size_t i = 0; i < 2; ++i) {
    const MeshData mesh = reader->frame(i);
    EXPECT_EQ(mesh.points.size(), 46'598u);
    EXPECT_EQ(mesh.triangles.size(), 92'230u);
    for (const auto& point : mesh.points) {
      // The scene is 12 m wide; a byte order mixed up would give values all over the range of float.
      for (const double x : point) ASSERT_LT(std::abs(x), 100.0);
    }
  }
}

TEST_F(PublicFiles, LittleEndianDoubleFramesOfRodTwist) {
  const std::filesystem::path frames = data_ / "ccd/scalable-ccd/rod-twist/frames";
  const auto reader = open_sequence({frames / "3036.ply", frames / "3037.ply"});
  EXPECT_TRUE(reader->same_faces_as_previous(1));
  EXPECT_EQ(reader->precision(), Precision::kFloat64);
  EXPECT_EQ(reader->frame(1).points.size(), 39'940u);
  EXPECT_EQ(reader->frame(1).triangles.size(), 79'864u);
}

TEST_F(PublicFiles, HandcraftedQueriesAreExactlyDoubles) {
  std::size_t queries = 0, true_answers = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data_ / "ccd/sample-queries")) {
    if (entry.path().extension() != ".csv") continue;
    for (const CcdQuery& query : read_query_csv(entry.path())) {
      ASSERT_TRUE(query.truth.has_value());
      ++queries;
      true_answers += *query.truth ? 1 : 0;
    }
  }
  EXPECT_EQ(queries, 2500u);
  EXPECT_GT(true_answers, 0u);
  EXPECT_LT(true_answers, queries);
}

TEST_F(PublicFiles, RodTwistQueriesAreVerticesOfItsFrames) {
  const std::filesystem::path rod = data_ / "ccd/scalable-ccd/rod-twist";
  const std::vector<CcdQuery> queries = read_query_csv(rod / "queries/3036vf.csv");
  ASSERT_GT(queries.size(), 765u) << "at least the true collisions";
  Points ends[2] = {read_mesh(rod / "frames/3036.ply").points, read_mesh(rod / "frames/3037.ply").points};
  for (Points& points : ends) std::sort(points.begin(), points.end());
  for (const CcdQuery& query : queries) {
    EXPECT_FALSE(query.truth.has_value());
    for (std::size_t row = 0; row < 8; ++row) {
      ASSERT_TRUE(std::binary_search(ends[row / 4].begin(), ends[row / 4].end(), query.points[row]))
          << "the rational and the binary file must give the same double";
    }
  }
}

struct PublicSequence {
  const char* file;
  std::size_t frames, vertices, faces, bodies;  // as numpy reads them
  Precision precision;
  /// In the names of tests.
  friend void PrintTo(const PublicSequence& sequence, std::ostream* out) { *out << sequence.file; }
};

class PublicSequences : public PublicFiles, public ::testing::WithParamInterface<PublicSequence> {};

TEST_P(PublicSequences, AreReadWhole) {
  const auto reader = open_sequence({data_ / "sequences" / GetParam().file});
  EXPECT_EQ(reader->frame_count(), GetParam().frames);
  EXPECT_EQ(reader->precision(), GetParam().precision);
  std::size_t bodies = 0;
  for (const Group& group : reader->groups()) {
    if (group.role == Group::Role::kBody) bodies += static_cast<std::size_t>(group.face_end - group.face_begin);
  }
  EXPECT_EQ(bodies, GetParam().bodies);
  for (std::size_t i = 0; i < reader->frame_count(); ++i) {
    const MeshData mesh = reader->frame(i);
    EXPECT_EQ(mesh.points.size(), GetParam().vertices);
    EXPECT_EQ(mesh.triangles.size(), GetParam().faces);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, PublicSequences,
    ::testing::Values(PublicSequence{"blender-table-50.npz", 15, 5'399, 10'546, 5'744, Precision::kFloat64},
                      PublicSequence{"blender-curtain-150.npz", 10, 27'705, 54'770, 10'368, Precision::kFloat64},
                      PublicSequence{"eltopo-curtain-50.npz", 20, 3'865, 7'490, 2'688, Precision::kFloat64}));

}  // namespace
}  // namespace selvage::io
