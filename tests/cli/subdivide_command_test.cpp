#include <gtest/gtest.h>

#include "io/sequence.h"
#include "tests/cli/run_program.h"

namespace selvage {
namespace {

using testing::run_program;
using testing::TemporaryFolder;

/// Two tents of four faces, the second one `gap` above the first; below 0 they intersect.
void record(const std::filesystem::path& folder, double gap) {
  io::Points points;
  io::Triangles triangles;
  for (const double z : {0.0, gap}) {
    const auto base = static_cast<std::int32_t>(points.size());
    points.insert(points.end(), {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}, {0, 0, 0.5 + z}});
    for (std::int32_t k = 0; k < 4; ++k) triangles.push_back({base + k, base + (k + 1) % 4, base + 4});
  }
  io::SequenceWriter writer(folder, {triangles, {}, io::SequenceKind::kFrames, io::Precision::kFloat64, "test"});
  writer.append(0, points);
  for (auto& p : points) p[0] += 1;
  writer.append(0.5, points);
}

}  // namespace

TEST(SubdivideCommand, WritesFinerFramesThatVerifyFindsClean) {
  const TemporaryFolder folder;
  record(folder.path() / "run", 0.01);
  const auto result =
      run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "fine", "--levels", "2"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("2 frames, 8 faces to 128"), std::string::npos) << result.out;
  const auto fine = io::open_sequence({folder.path() / "fine"});
  ASSERT_EQ(fine->frame_count(), 2U);
  EXPECT_EQ(fine->frame(1).triangles.size(), 128U);
  EXPECT_EQ(fine->time(1), 0.5);
  EXPECT_EQ(run_program(folder, {"verify", folder.path() / "fine"}).exit_code, 0);

  const auto one =
      run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "one", "--frame", "1"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(io::open_sequence({folder.path() / "one"})->frame_count(), 1U);
  EXPECT_EQ(
      run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "two", "--frame", "2"}).exit_code,
      2);
}

TEST(SubdivideCommand, RefusesFramesThatIntersect) {
  const TemporaryFolder folder;
  record(folder.path() / "run", 0);
  const auto result = run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "fine"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.out.find("intersect already"), std::string::npos) << result.out;
}

}  // namespace selvage
