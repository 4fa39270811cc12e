// The second opinion inside the checks: asked about what it should be, and heard.
#include <random>

#include <gtest/gtest.h>

#include "tests/verify/frames.h"
#include "tests/verify/sheet.h"
#include "verify/check.h"
#include "verify/decision/exact_overlap.h"

namespace selvage::verify {
namespace {

using selvage::testing::Frames;
using selvage::testing::sheet;

/// A sheet, and a triangle that lies in it with its corners on faces.
io::MeshData touched_sheet(double height) {
  io::MeshData mesh = sheet(5);
  const auto p = testing::add_vertex(mesh, testing::point_on(mesh, 7, {1, 1, 2}, height)),
             q = testing::add_vertex(mesh, {1.5, 1.25, height + 2}),
             r = testing::add_vertex(mesh, {1.25, 1.5, height + 2});
  mesh.triangles.push_back({p, q, r});
  return mesh;
}

SequenceReport check(SecondOpinionScope scope, const SecondDeciders& deciders = {}) {
  SequenceOptions options;
  options.check.second_opinion = scope;
  options.check.second_deciders = deciders;
  return check_sequence(Frames({touched_sheet(1), touched_sheet(0), touched_sheet(-1)}), options);
}

std::int64_t examined(const SequenceReport& report) {
  return report.pairs.vf + report.pairs.ee + report.pairs.overlap + report.pairs.self;
}

}  // namespace

TEST(SecondOpinionCheck, AsksAboutWhatNoFilterDecidedOrAboutAll) {
  EXPECT_EQ(check(SecondOpinionScope::kNone).pairs.asked_again, 0);
  const SequenceReport undecided = check(SecondOpinionScope::kUndecided);
  EXPECT_EQ(undecided.verdict, Verdict::kViolated);
  EXPECT_EQ(undecided.pairs.disagreed, 0);
  EXPECT_GE(undecided.pairs.asked_again, std::max(undecided.pairs.exact, undecided.violations_total.total()));
  EXPECT_LE(undecided.pairs.asked_again, undecided.pairs.exact + undecided.violations_total.total());
  const SequenceReport all = check(SecondOpinionScope::kAll);
  EXPECT_EQ(all.pairs.asked_again, examined(all));
  EXPECT_EQ(all.pairs.disagreed, 0);
  EXPECT_EQ(all.violations_total.total(), undecided.violations_total.total());
}

TEST(SecondOpinionCheck, ADeciderThatLiesIsHeard) {
  SecondDeciders liar;
  liar.overlap = [](const auto& face_a, const auto& a, const auto& face_b, const auto& b) {
    return !second_opinion_overlap(face_a, a, face_b, b);
  };
  SequenceReport report = check(SecondOpinionScope::kUndecided, liar);
  EXPECT_EQ(report.verdict, Verdict::kUnknown) << "no verdict while the deciders differ";
  EXPECT_GT(report.pairs.disagreed, 0);
  ASSERT_FALSE(report.disagreements.empty());
  EXPECT_EQ(report.disagreements[0].event, EventKind::kOverlap);
  EXPECT_EQ(report.disagreements[0].x_t0.size(), 6U);

  liar = {};
  liar.vf = [](const auto&, const auto&) { return SecondOpinion{}; };  // never touches
  report = check(SecondOpinionScope::kUndecided, liar);
  EXPECT_EQ(report.verdict, Verdict::kUnknown);
  EXPECT_EQ(report.pairs.disagreed, report.violations_total.vf);
  EXPECT_EQ(report.disagreements.at(0).kind, "touches");
  for (const auto event : {0, 1, 2}) {  // pairs that do not touch are asked about with `all`
    liar = {};
    const auto always = [](const auto&, const auto&) { return SecondOpinion{true, 0, 0}; };
    if (event == 0) liar.ee = always;
    if (event == 1) liar.self = always;
    if (event == 2) liar.degenerate = [](const auto&) { return true; };
    report = check(SecondOpinionScope::kAll, liar);
    EXPECT_GT(report.pairs.disagreed, 1) << event;
    EXPECT_EQ(std::ssize(report.disagreements), std::min(report.pairs.disagreed, report.max_violations)) << event;
    EXPECT_EQ(report.disagreements.at(0).kind, "apart") << event;
  }
}

TEST(SecondOpinionOverlap, AgreesOnSmallIntegersOfEveryIncidence) {
  std::mt19937 random(11);
  std::int64_t touching = 0, apart = 0;
  for (int round = 0; round < 6000; ++round) {
    const int range = 2 + round % 3, shared = round / 3 % 3;
    std::array<Point, 3> a, b;
    const auto coordinate = [&] { return static_cast<double>(random() % static_cast<unsigned>(range)); };
    for (Point& p : a) p = {coordinate(), coordinate(), round % 5 == 0 ? 0 : coordinate()};
    for (Point& p : b) p = {coordinate(), coordinate(), round % 5 == 0 ? 0 : coordinate()};
    std::array<std::int32_t, 3> face_a = {0, 1, 2}, face_b = {3, 4, 5};
    for (std::size_t i = 0; i < static_cast<std::size_t>(shared); ++i) {
      b[(i + 1) % 3] = a[i];
      face_b[(i + 1) % 3] = face_a[i];
    }
    const bool exact = exact_overlap(face_a, a, face_b, b).kind != OverlapKind::kNone;
    ASSERT_EQ(second_opinion_overlap(face_a, a, face_b, b), exact) << round;
    ASSERT_EQ(second_opinion_degenerate(a), exact_degenerate(a).is_degenerate) << round;
    ++(exact ? touching : apart);
  }
  EXPECT_GT(touching, 1000);
  EXPECT_GT(apart, 1000);
}

}  // namespace selvage::verify
