// Exempt, ignored and welded parts of a sequence: what is left is checked, what is left out is counted.
#include <gtest/gtest.h>

#include "tests/verify/frames.h"
#include "tests/verify/sheet.h"
#include "verify/check.h"

namespace selvage::verify {
namespace {

using selvage::testing::add_vertex;
using selvage::testing::Frames;
using selvage::testing::sheet;

constexpr std::int32_t kSheetFaces = 50;

/// A sheet of 50 faces, and a triangle (face 50) that pierces it.
io::MeshData pierced_sheet() {
  io::MeshData mesh = sheet(5);
  const auto p = add_vertex(mesh, {1.25, 1.25, 3}), q = add_vertex(mesh, {1.5, 1.25, 3}),
             r = add_vertex(mesh, {1.25, 1.5, -3});
  mesh.triangles.push_back({p, q, r});
  mesh.groups = {{"shirt", io::Group::Role::kCloth, 0, kSheetFaces},
                 {"pin", io::Group::Role::kCloth, kSheetFaces, kSheetFaces + 1}};
  return mesh;
}

SequenceReport check(std::vector<io::MeshData> frames, const GroupRules& rules, bool weld = false) {
  SequenceOptions options;
  options.rules = rules;
  options.weld = weld;
  return check_sequence(Frames(std::move(frames)), options);
}

/// Two sheets side by side; the vertices along their common line are there twice.
io::MeshData split_sheet() {
  io::MeshData mesh = sheet(4);
  const io::MeshData other = sheet(4);
  const auto offset = static_cast<std::int32_t>(mesh.points.size());
  for (Point p : other.points) {
    p[0] = 8 - p[0];  // mirrored, so that the heights along x = 4 agree
    mesh.points.push_back(p);
  }
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + offset, c + offset, b + offset});
  return mesh;
}

}  // namespace

TEST(Allowances, AnExemptPairIsCountedAndNothingElseIsLeftOut) {
  const io::MeshData mesh = pierced_sheet();
  EXPECT_EQ(check({mesh, mesh}, {}).verdict, Verdict::kViolated);
  const SequenceReport exempt = check({mesh, mesh}, {{}, {{"shirt", "pin"}}, {}});
  EXPECT_EQ(exempt.verdict, Verdict::kClean);
  ASSERT_EQ(exempt.exempted.size(), 1U);
  EXPECT_GT(exempt.exempted[0].pairs, 0);
  EXPECT_EQ(exempt.exempted[0].groups, (std::array<std::string, 2>{"shirt", "pin"}));
  const SequenceReport all = check({mesh, mesh}, {});
  EXPECT_EQ(exempt.pairs.overlap + exempt.pairs.vf + exempt.pairs.ee + exempt.exempted[0].pairs,
            all.pairs.overlap + all.pairs.vf + all.pairs.ee);
  EXPECT_EQ(exempt.pairs.self, all.pairs.self) << "a face and itself are no pair";
  // Within the shirt is another matter.
  const SequenceReport within = check({mesh, mesh}, {{}, {{"shirt", "shirt"}}, {}});
  EXPECT_EQ(within.verdict, Verdict::kViolated);
  EXPECT_EQ(within.violations_total.overlap, all.violations_total.overlap);
}

TEST(Allowances, AGroupMadeByTheUserIsLikeOneOfTheSequence) {
  io::MeshData mesh = pierced_sheet();
  mesh.groups.clear();
  const GroupRules rules = {
      {{"a", io::Group::Role::kCloth, 0, 50}, {"b", io::Group::Role::kCloth, 50, 51}}, {{"b", "a"}}, {}};
  EXPECT_EQ(check({mesh}, rules).verdict, Verdict::kClean);
  EXPECT_THROW(check({mesh}, {{}, {{"a", "b"}}, {}}), GroupRuleError);
}

TEST(Allowances, AnIgnoredGroupIsNoPartOfTheCheck) {
  const io::MeshData mesh = pierced_sheet();
  const SequenceReport report = check({mesh, mesh}, {{}, {}, {"pin"}});
  EXPECT_EQ(report.verdict, Verdict::kClean);
  ASSERT_EQ(report.ignored.size(), 1U);
  EXPECT_EQ(report.ignored[0].faces, 1);
  const SequenceReport alone = check({sheet(5), sheet(5)}, {});
  EXPECT_EQ(report.pairs.overlap, alone.pairs.overlap);
  EXPECT_EQ(report.pairs.ee, alone.pairs.ee);
  EXPECT_EQ(report.pairs.self, alone.pairs.self);
}

TEST(Allowances, WithEverythingAllowedNothingIsClean) {
  const io::MeshData mesh = pierced_sheet();
  for (const GroupRules& rules :
       {GroupRules{{}, {}, {"shirt", "pin"}}, GroupRules{{}, {{"shirt", "shirt"}, {"shirt", "pin"}}, {}},
        GroupRules{{}, {{"shirt", "shirt"}}, {"pin"}}, GroupRules{{}, {}, {"shirt"}}}) {
    const SequenceReport report = check({mesh, mesh}, rules);
    EXPECT_EQ(report.verdict, Verdict::kUnknown);
    const bool has_face = rules.ignore.size() < 2;  // then it is checked for its area, and no pair is
    EXPECT_EQ(report.frames.checked, has_face ? 2 : 0);
    EXPECT_EQ(report.unchecked.size(), 3U) << "two frames and a motion";
  }
}

// An edge that both hold was checked against the body's own edges, though no two faces were owed it.
TEST(Allowances, APairIsLeftOutWherePartOfItIsExemptAndTheRestOfBodiesAlone) {
  const auto frame = [](double z) {  // two faces of a body, a face of cloth sewn to an edge of the first
    io::MeshData mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, z}, {0.9, 0.9, z}, {0.2, 0.2, z + 1}, {2, 2, 0}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {1, 2, 6}};
    mesh.groups = {{"body", io::Group::Role::kBody, 0, 2}, {"cloth", io::Group::Role::kCloth, 2, 3}};
    return mesh;
  };
  SequenceOptions options;
  options.gap = true;
  options.check.min_distance = 5;
  const Frames through({frame(0.5), frame(-2.5)});
  EXPECT_EQ(check_sequence(through, options).verdict, Verdict::kViolated);
  options.rules.exempt = {{"body", "cloth"}};
  const SequenceReport exempt = check_sequence(through, options);
  EXPECT_EQ(exempt.verdict, Verdict::kUnknown);
  EXPECT_EQ(exempt.unchecked.size(), 3U) << "two frames and a motion";
  EXPECT_EQ(exempt.violations_total.total(), 0);
  EXPECT_FALSE(exempt.gap);
  EXPECT_EQ(exempt.pairs.vf + exempt.pairs.ee, 0);
  ASSERT_EQ(exempt.exempted.size(), 1U);
  EXPECT_GT(exempt.exempted[0].pairs, 0);
  options.check.check_bodies = true;
  EXPECT_EQ(check_sequence(through, options).verdict, Verdict::kViolated) << "the bodies meet each other";
}

TEST(Allowances, WeldingClosesASeamThatNeverOpens) {
  const io::MeshData mesh = split_sheet();
  EXPECT_EQ(check({mesh, mesh}, {}).verdict, Verdict::kViolated) << "duplicate vertices touch";
  const SequenceReport welded = check({mesh, mesh}, {}, true);
  EXPECT_EQ(welded.verdict, Verdict::kClean);
  ASSERT_TRUE(welded.welded);
  EXPECT_EQ(welded.welded->vertices, 5);
  EXPECT_EQ(welded.welded->collapsed_faces, 0);
  EXPECT_EQ(welded.unreferenced_vertices, 0);
  // One vertex that parts in one frame stays two: where the others are joined it touches.
  io::MeshData parted = mesh;
  parted.points[4][0] += 0x1p-20;
  const SequenceReport open = check({mesh, parted}, {}, true);
  EXPECT_EQ(open.welded->vertices, 4);
  EXPECT_EQ(open.verdict, Verdict::kViolated);
}

// Mirroring x in a program negates zeros too. Over the reals the two halves meet, and so they touched.
TEST(Allowances, WeldingClosesASeamOfAMirroredGarment) {
  using Corners = std::array<Point, 3>;
  const Corners right{Point{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, left{Point{-0.0, 0, 0}, {-0.0, 1, 0}, {-1, 0, 0}};
  io::MeshData mesh;
  for (const Corners& face : {right, left}) mesh.points.insert(mesh.points.end(), face.begin(), face.end());
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(check({mesh, mesh}, {}).verdict, Verdict::kViolated);
  const SequenceReport welded = check({mesh, mesh}, {}, true);
  EXPECT_EQ(welded.verdict, Verdict::kClean);
  EXPECT_EQ(welded.welded.value().vertices, 2);
}

// Body faces that lost a corner were left out of all pairs: cloth that they pierce was called clean.
TEST(Allowances, BodyFacesThatWeldingCollapsesAreCheckedAgainstCloth) {
  const Point low{1, 1, -1}, high{1, 1, 1}, inside{1, 1, 0}, far{1, 1, 9};
  using Corners = std::array<Point, 3>;
  const struct {
    Corners first, last;  // of the body, in two frames
    bool in_frame, in_motion;
    double gap;
    const char* why;
  } cases[] = {
      {Corners{low, high, high}, Corners{low, high, high}, true, false, 1, "a segment pierces in both frames"},
      {Corners{inside, inside, inside}, Corners{inside, inside, inside}, true, true, 0, "a point lies in the cloth"},
      {Corners{low, low, low}, Corners{high, high, high}, false, true, 1, "a point moves through"},
      {Corners{Point{1, 1, 2}, {5, 5, 2}, {5, 5, 2}}, Corners{Point{1, 1, -2}, {5, 5, -2}, {5, 5, -2}}, false, true, 2,
       "a segment moves through"},
      {Corners{high, far, far}, Corners{high, far, far}, false, false, 1, "a segment above"},
      {Corners{high, high, high}, Corners{high, high, high}, false, false, 1, "a point above"}};
  for (const auto& [first, last, in_frame, in_motion, gap, why] : cases) {
    for (const bool weld : {false, true}) {
      const auto frame = [](const std::array<Point, 3>& body) {
        io::MeshData mesh;
        mesh.points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, body[0], body[1], body[2]};
        mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
        mesh.groups = {{"wall", io::Group::Role::kBody, 1, 2}};
        return mesh;
      };
      SequenceOptions options;
      options.weld = weld;
      options.gap = true;
      const SequenceReport report = check_sequence(Frames({frame(first), frame(last)}), options);
      EXPECT_EQ(report.verdict, in_frame || in_motion ? Verdict::kViolated : Verdict::kClean) << why << weld;
      EXPECT_EQ(report.frames.violated, in_frame ? 2 : 0) << why << weld;
      EXPECT_EQ(report.motions.violated, in_motion ? 1 : 0) << why << weld;
      EXPECT_EQ(report.violations_total.self, 0) << why << weld << ": areas of bodies were not asked for";
      EXPECT_EQ(report.gap.value_or(Gap{-1, -1}).upper, gap) << why << weld;
      EXPECT_EQ(report.body_faces, 1);
      EXPECT_EQ(report.welded ? report.welded->collapsed_faces : 1, 1);
    }
  }
}

TEST(Allowances, ABodyWithPolesOfManyVerticesIsCleanFarFromTheCloth) {
  // Eight quadrilaterals between two poles, each corner at a pole a vertex of its own: half of the faces collapse.
  io::MeshData mesh = sheet(4);
  const auto cloth_faces = static_cast<std::int32_t>(mesh.triangles.size());
  std::array<std::array<std::int32_t, 4>, 8> meridians{};
  constexpr std::array<std::array<double, 2>, 8> kRing = {{{2, 0},
                                                           {1, 1},
                                                           {0, 2},
                                                           {-1, 1},  //
                                                           {-2, 0},
                                                           {-1, -1},
                                                           {0, -2},
                                                           {1, -1}}};
  for (std::size_t i = 0; i < 8; ++i) {
    const auto [x, y] = kRing[i];
    meridians[i] = {add_vertex(mesh, {0, 0, 4}), add_vertex(mesh, {x, y, 5}), add_vertex(mesh, {x, y, 6}),
                    add_vertex(mesh, {0, 0, 7})};
  }
  for (std::size_t i = 0; i < 8; ++i) {
    const auto &mine = meridians[i], &next = meridians[(i + 1) % 8];
    for (std::size_t k = 0; k < 3; ++k) {
      mesh.triangles.push_back({mine[k], next[k], next[k + 1]});
      mesh.triangles.push_back({mine[k], next[k + 1], mine[k + 1]});
    }
  }
  mesh.groups = {{"ball", io::Group::Role::kBody, cloth_faces, static_cast<std::int32_t>(mesh.triangles.size())}};
  const SequenceReport far = check({mesh, mesh}, {}, true);
  EXPECT_EQ(far.verdict, Verdict::kClean);
  EXPECT_EQ(far.welded->collapsed_faces, 16);
  for (std::size_t i = 25; i < mesh.points.size(); ++i) mesh.points[i][2] -= 5;
  EXPECT_EQ(check({mesh, mesh}, {}, true).verdict, Verdict::kViolated);
}

TEST(Allowances, ClothMayShareWeldedVerticesWithABodyFaceThatCollapses) {
  // The body's face becomes a vertex of the cloth, or an edge, or a segment that starts at one and leaves the cloth.
  const Point corner{0, 0, 0}, other{4, 0, 0}, above{0, 0, 3}, along{1, 1, 0};
  const struct {
    std::array<Point, 3> body;
    Verdict verdict;
    const char* why;
  } cases[] = {{{corner, corner, corner}, Verdict::kClean, "a vertex"},
               {{corner, corner, other}, Verdict::kClean, "an edge"},
               {{other, corner, corner}, Verdict::kClean, "an edge"},
               {{above, corner, corner}, Verdict::kClean, "a segment away from it"},
               {{corner, corner, along}, Verdict::kViolated, "a segment within it"}};
  for (const auto& [body, verdict, why] : cases) {
    io::MeshData mesh;
    mesh.points = {corner, other, {0, 4, 0}, body[0], body[1], body[2]};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    mesh.groups = {{"wall", io::Group::Role::kBody, 1, 2}};
    const SequenceReport report = check({mesh, mesh}, {}, true);
    EXPECT_EQ(report.verdict, verdict) << why;
    EXPECT_EQ(report.motions.violated, verdict == Verdict::kViolated ? 1 : 0) << why;
  }
}

TEST(Allowances, AFaceThatWeldingCollapsesIsAViolationInEveryFrame) {
  io::MeshData mesh = sheet(4);
  const auto copy = add_vertex(mesh, mesh.points[0]);
  mesh.triangles.push_back({0, copy, 24});
  const SequenceReport report = check({mesh, mesh, mesh}, {}, true);
  EXPECT_EQ(report.verdict, Verdict::kViolated);
  EXPECT_EQ(report.welded->collapsed_faces, 1);
  std::vector<std::int64_t> frames;
  for (const Violation& violation : report.violations) {
    if (violation.kind != "degenerate") continue;
    frames.push_back(violation.frame);
    EXPECT_EQ(violation.features, (std::array<std::int32_t, 2>{0, 32}));
    EXPECT_EQ(violation.x_t0.size(), 3U);
  }
  EXPECT_EQ(frames, (std::vector<std::int64_t>{0, 1, 2}));
  const SequenceReport ignoring = check({mesh}, {{{"sliver", io::Group::Role::kCloth, 32, 33}}, {}, {"sliver"}}, true);
  EXPECT_EQ(ignoring.verdict, Verdict::kClean);
  EXPECT_EQ(ignoring.welded->collapsed_faces, 0) << "it is no part of the check";
}

TEST(Allowances, WeldingNeedsOneSurface) {
  io::MeshData other = sheet(4);
  std::swap(other.triangles[3], other.triangles[4]);
  EXPECT_THROW(check({sheet(4), other}, {}, true), io::Error);
}

}  // namespace selvage::verify
