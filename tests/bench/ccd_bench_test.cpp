#include "bench/ccd_bench.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/error.h"
#include "io/mesh_reader.h"
#include "tests/public_data.h"

namespace selvage::bench {
namespace {

/// A face in the plane z = 0 and one above it, whose vertex 3 moves from z = 1 to `end_z`. The others stay above.
MeshMotion falling_corner(double end_z) {
  Faces F(2, 3);
  F << 0, 1, 2, 3, 4, 5;
  MeshMotion motion{make_mesh(6, F), Positions(6, 3), Positions(6, 3)};
  motion.V_t0 << 0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1, -3, 1, 9, 5, 1, 9;
  motion.V_t1 = motion.V_t0;
  motion.V_t1(3, 2) = end_z;
  return motion;
}

CcdBenchReport run(const MeshMotion& motion, std::span<const LabelledPair> labels = {}, double tolerance = 0) {
  return run_ccd_bench(motion, time_candidates(motion, tolerance), labels, {.tolerance = tolerance, .repeat = 1});
}

const CcdMethodReport& method(const CcdBenchReport& report, const std::string& name) {
  return *std::find_if(report.methods.begin(), report.methods.end(), [&](const auto& m) { return m.name == name; });
}

TEST(CcdBench, CountsTheContactsOfAMotion) {
  const CcdBenchReport report = run(falling_corner(-1));
  EXPECT_EQ(report.vf_contacts, 1);
  EXPECT_EQ(report.ee_contacts, 0);
  for (const CcdMethodReport& of_method : report.methods) {
    EXPECT_EQ(of_method.alarms, 1) << of_method.name;
    EXPECT_EQ(of_method.false_negatives, 0) << of_method.name;
    EXPECT_EQ(of_method.false_positives, 0) << of_method.name;
    EXPECT_EQ(of_method.toi_examined, of_method.name == "exact" ? 0 : 1) << of_method.name;
    EXPECT_GT(of_method.ns_mean, 0) << of_method.name;
  }
  EXPECT_EQ(method(report, "textbook").ratio, 1);
}

/// Near the end and no contact: the kernel's alarm for the tolerance is within its bound, the textbook's has none.
TEST(CcdBench, FalsePositivesAreHeldAgainstTheirOwnBound) {
  const CcdBenchReport report = run(falling_corner(0x1p-21), {}, 0x1p-20);
  EXPECT_EQ(report.vf_contacts, 0);
  EXPECT_EQ(method(report, "kernel_scalar").false_positives, 1);
  EXPECT_EQ(method(report, "kernel_scalar").false_positives_beyond_gap, 0);
  EXPECT_EQ(method(report, "textbook").false_positives, 1);
  EXPECT_EQ(method(report, "textbook").false_positives_beyond_gap, 1);
}

TEST(CcdBench, PublishedVerdictsAreComparedWithTheExactOnes) {
  const std::array<LabelledPair, 4> labels{{{PairKind::kVf, 3, 0, true},     // right
                                            {PairKind::kVf, 0, 1, false},    // right: not even a candidate
                                            {PairKind::kEe, 0, 3, true},     // a lie
                                            {PairKind::kVf, 3, 0, false}}};  // the other one
  const CcdBenchReport report = run(falling_corner(-1), labels);
  EXPECT_EQ(report.labels, 4);
  EXPECT_EQ(report.labels_contradicted, 2);
}

TEST(CcdBench, TheCrumpledSheetHasContactsAndIsAlwaysTheSame) {
  const MeshMotion sheet = crumpled_sheet(40);
  EXPECT_EQ(sheet.V_t1, crumpled_sheet(40).V_t1);
  const CcdBenchReport report = run(sheet);
  EXPECT_EQ(report.vertices, 1600);
  EXPECT_GT(report.vf_contacts, 10);
  EXPECT_GT(report.ee_contacts, 40);
  for (const char* name : {"kernel", "kernel_scalar"}) {
    EXPECT_EQ(method(report, name).false_negatives, 0) << name;
    EXPECT_EQ(method(report, name).toi.late, 0) << name;
    EXPECT_EQ(method(report, name).false_positives_beyond_gap, 0) << name;
  }
  const std::int64_t candidates = report.vf_candidates + report.ee_candidates;
  EXPECT_LT(method(report, "kernel").searched, candidates / 1000);
}

TEST(CcdBench, JsonCarriesItsSchema) {
  const auto json = nlohmann::json::parse(to_json(run(falling_corner(-1))));
  EXPECT_EQ(json.at("schema"), "selvage.bench.ccd/1");
  EXPECT_EQ(json.at("contacts").at("vf"), 1);
  for (const char* name : {"kernel", "kernel_scalar", "textbook", "exact"}) {
    const auto& of_method = json.at("methods").at(name);
    EXPECT_TRUE(of_method.at("false_negatives").is_number_integer()) << name;
    EXPECT_TRUE(of_method.at("false_positives").is_number_integer()) << name;
    EXPECT_TRUE(of_method.at("ns").at("mean").is_number()) << name;
    EXPECT_TRUE(json.at("ratio_to_textbook").at(name).is_number()) << name;
  }
}

TEST(CcdBench, FramesThatDoNotFitTogetherAreRefused) {
  const io::MeshData face{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}};
  io::MeshData other = face;
  other.points.push_back({0, 0, 1});
  EXPECT_THROW(static_cast<void>(mesh_motion(face, other)), io::Error);
  EXPECT_THROW(static_cast<void>(mesh_motion({}, {})), io::Error);
  EXPECT_EQ(mesh_motion(face, face).mesh.edges.size(), 3U);
}

TEST(CcdBench, PublishedContactsAreFoundAndNothingElse) {
  const auto data = testing::public_data();
  if (!data) GTEST_SKIP() << "no public data: set SELVAGE_DATA";
  const auto scene = *data / "ccd" / "scalable-ccd" / "rod-twist";
  const MeshMotion motion =
      mesh_motion(io::read_mesh(scene / "frames" / "3036.ply"), io::read_mesh(scene / "frames" / "3037.ply"));
  std::vector<LabelledPair> labels;
  for (const std::string kind : {"3036vf", "3036ee"}) {
    const auto read = read_pair_labels(scene / "boxes" / (kind + ".json"),
                                       scene / "mma_bool" / (kind + "_mma_bool.json"), motion.mesh);
    labels.insert(labels.end(), read.begin(), read.end());
  }
  const CcdBenchReport report = run(motion, labels);
  EXPECT_EQ(report.labels, 801 + 4'370);
  EXPECT_EQ(report.labels_contradicted, 0);
  EXPECT_EQ(report.vf_contacts, 765);
  EXPECT_EQ(report.ee_contacts, 4'179);
  for (const CcdMethodReport& of_method : report.methods) {
    if (of_method.name == "textbook") continue;
    EXPECT_EQ(of_method.alarms, 765 + 4'179) << of_method.name;
    EXPECT_EQ(of_method.false_negatives, 0) << of_method.name;
    EXPECT_EQ(of_method.toi.late, 0) << of_method.name;
  }
}

}  // namespace
}  // namespace selvage::bench
