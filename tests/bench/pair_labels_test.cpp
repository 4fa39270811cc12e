#include "bench/pair_labels.h"

#include <gtest/gtest.h>

#include "io/error.h"
#include "tests/temporary_folder.h"

namespace selvage::bench {
namespace {

/// Two faces: vertices 0-5, edges 6-11, faces 12-13.
class PairLabels : public ::testing::Test {
 protected:
  PairLabels() {
    Faces F(2, 3);
    F << 0, 1, 2, 3, 4, 5;
    mesh_ = make_mesh(6, F);
  }

  std::vector<LabelledPair> read(const std::string& boxes, const std::string& verdicts) {
    testing::spit(folder_ / "boxes.json", boxes);
    testing::spit(folder_ / "verdicts.json", verdicts);
    return read_pair_labels(folder_ / "boxes.json", folder_ / "verdicts.json", mesh_);
  }

  testing::TemporaryFolder folder_;
  Mesh mesh_;
};

TEST_F(PairLabels, IdsSayTheKindInAnyOrder) {
  const auto labels = read("[[3, 12], [13, 0], [9, 6]]", "[true, false, true]");
  ASSERT_EQ(labels.size(), 3U);
  EXPECT_EQ(labels[0].kind, PairKind::kVf);
  EXPECT_EQ(labels[0].first, 3);
  EXPECT_EQ(labels[0].second, 0);
  EXPECT_TRUE(labels[0].touches);
  EXPECT_EQ(labels[1].first, 0);
  EXPECT_EQ(labels[1].second, 1);
  EXPECT_FALSE(labels[1].touches);
  EXPECT_EQ(labels[2].kind, PairKind::kEe);
  EXPECT_EQ(labels[2].first, 0);
  EXPECT_EQ(labels[2].second, 3);
}

TEST_F(PairLabels, WrongListsAreRefused) {
  EXPECT_THROW(read("[[3, 12]]", "[true, false]"), io::Error);
  EXPECT_THROW(read("[[3, 14]]", "[true]"), io::Error);  // no such face
  EXPECT_THROW(read("[[-1, 12]]", "[true]"), io::Error);
  EXPECT_THROW(read("[[0, 1]]", "[true]"), io::Error);   // two vertices
  EXPECT_THROW(read("[[6, 6]]", "[true]"), io::Error);   // an edge with itself
  EXPECT_THROW(read("[[6, 12]]", "[true]"), io::Error);  // an edge and a face
  EXPECT_THROW(read("[[3, 12]", "[true]"), io::Error);
  EXPECT_THROW(read("[[3, 12]]", "[1]"), io::Error);
  EXPECT_THROW(read("{}", "[]"), io::Error);
  EXPECT_THROW(static_cast<void>(read_pair_labels(folder_ / "absent.json", folder_ / "absent.json", mesh_)), io::Error);
}

}  // namespace
}  // namespace selvage::bench
