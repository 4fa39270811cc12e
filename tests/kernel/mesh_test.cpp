#include "kernel/mesh.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "kernel/kernel.h"
#include "tests/property.h"

namespace selvage {

namespace {

Faces faces_of(const std::vector<std::array<VertexId, 3>>& list) {
  Faces F(static_cast<Eigen::Index>(list.size()), 3);
  for (std::size_t f = 0; f < list.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) F(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k)) = list[f][k];
  }
  return F;
}

}  // namespace

TEST(Requirements, AreAskedBeforeAnythingIsProved) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(validate(CcdOptions{}), InputError::kNone);
  for (const double bad : {-1.0, kNan, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(validate(CcdOptions{.tolerance = bad}), InputError::kBadTolerance) << bad;
  }
  EXPECT_EQ(validate(CcdOptions{.max_intervals = 0}), InputError::kBadOption);

  Faces F(2, 3);
  F << 0, 1, 2, 3, 4, 5;
  const Mesh mesh = make_mesh(6, F);
  BoxHierarchy hierarchy(mesh);
  const Positions V = Positions::Random(6, 3);
  Positions bad = V;
  bad(5, 2) = kNan;
  EXPECT_DEATH(static_cast<void>(find_collisions(mesh, hierarchy, V, bad, {})), "find_collisions is called without");
  EXPECT_DEATH(static_cast<void>(find_collisions(mesh, hierarchy, V, V, {.tolerance = -1})), "validate\\(options\\)");
  EXPECT_DEATH(static_cast<void>(find_proximities(mesh, hierarchy, bad, 0.1)),
               "is called without what it requires: validate");
  EXPECT_DEATH(static_cast<void>(BoxHierarchy(mesh).candidates()), "candidates is called without");
  for (const Eigen::Index faces : {1, 2}) {  // fewer, and as many that have another number of edges
    F.row(1) << 0, 2, 5;
    const Mesh other = make_mesh(6, F.topRows(faces));
    BoxHierarchy of_other(other);
    EXPECT_DEATH(static_cast<void>(find_collisions(mesh, of_other, V, V, {})), "find_collisions is called .*fits");
    EXPECT_DEATH(static_cast<void>(find_proximities(mesh, of_other, V, 0.1)), "is called without .*fits");
  }
  for (const Eigen::Index rows : {0, 5, 7}) {  // for 6 vertices
    const Positions other = Positions::Random(rows, 3);
    for (const std::size_t queries : {0U, 100U}) {  // one after another, and in lanes
      EXPECT_DEATH(static_cast<void>(CcdBatch(mesh, other, V, {}, queries)), "CcdBatch is called without .*rows");
      EXPECT_DEATH(static_cast<void>(CcdBatch(mesh, V, other, {}, queries)), "CcdBatch is called without .*rows");
    }
  }
  for (const std::size_t flags : {1U, 5U, 7U}) {  // of 6 vertices
    const std::vector<std::uint8_t> active(flags, 1);
    EXPECT_DEATH(static_cast<void>(find_collisions(mesh, hierarchy, V, V, {}, active)),
                 "is called without what it requires: .*active");
    EXPECT_DEATH(static_cast<void>(find_proximities(mesh, hierarchy, V, 0.1, active)),
                 "is called without what it requires: .*active");
    EXPECT_DEATH(static_cast<void>(find_near_candidates(mesh, hierarchy, V, 0.1, active)),
                 "is called without what it requires: .*active");
    EXPECT_DEATH(static_cast<void>(find_candidates_brute_force(mesh, V, V, {0, active})),
                 "is called without what it requires: .*active");
  }
  for (const double reach : {-1.0, kNan, std::numeric_limits<double>::infinity()}) {
    EXPECT_DEATH(hierarchy.refit(V, V, {reach, {}}), "refit is called without what it requires: .*reach");
    EXPECT_DEATH(static_cast<void>(find_candidates_brute_force(mesh, V, V, {reach, {}})),
                 "is called without what it requires: .*reach");
  }
}

TEST(InputErrorText, EveryErrorSaysWhatToDo) {
  constexpr int kLast = static_cast<int>(InputError::kInUse);
  for (int i = 0; i <= kLast; ++i) EXPECT_STRNE(describe(static_cast<InputError>(i)), "unknown error") << i;
  EXPECT_STREQ(describe(static_cast<InputError>(kLast + 1)), "unknown error") << "an error after the last";
  EXPECT_STREQ(describe(static_cast<InputError>(255)), "unknown error");
}

TEST(ValidateFaces, NamesTheDefect) {
  EXPECT_EQ(validate_faces(3, faces_of({{0, 1, 2}})), InputError::kNone);
  EXPECT_EQ(validate_faces(0, faces_of({})), InputError::kNone);
  EXPECT_EQ(validate_faces(3, faces_of({{0, 1, 3}})), InputError::kIndexOutOfRange);
  EXPECT_EQ(validate_faces(3, faces_of({{0, -1, 2}})), InputError::kIndexOutOfRange);
  EXPECT_EQ(validate_faces(0, faces_of({{0, 1, 2}})), InputError::kIndexOutOfRange);
  EXPECT_EQ(validate_faces(-1, faces_of({})), InputError::kIndexOutOfRange);
  EXPECT_EQ(validate_faces(3, faces_of({{0, 1, 2}, {0, 0, 1}})), InputError::kRepeatedVertex);
  EXPECT_EQ(validate_faces(3, faces_of({{0, 1, 1}})), InputError::kRepeatedVertex);
  EXPECT_EQ(validate_faces(3, faces_of({{1, 0, 1}})), InputError::kRepeatedVertex);
}

TEST(ValidateFaces, RefusesMoreFacesThanEdgeNumbersWithoutReadingThem) {
  const Eigen::Map<const Faces> unreadable(nullptr, std::numeric_limits<EdgeId>::max() / 3 + 1, 3);
  EXPECT_EQ(validate_faces(3, unreadable), InputError::kTooManyFaces);
}

TEST(ValidatePositions, NamesTheDefect) {
  const Mesh mesh = make_mesh(2, faces_of({}));
  const Positions good = Positions::Constant(2, 3, -kMaxCoordinate);
  EXPECT_EQ(validate(mesh, good, good), InputError::kNone);
  EXPECT_EQ(validate(mesh, good, Positions::Zero(3, 3)), InputError::kSizeMismatch);
  EXPECT_EQ(validate(mesh, Positions::Zero(1, 3), good), InputError::kSizeMismatch);
  const std::pair<double, InputError> bad_values[] = {
      {std::numeric_limits<double>::quiet_NaN(), InputError::kNotFinite},
      {-std::numeric_limits<double>::infinity(), InputError::kNotFinite},
      {-0x1.0000000000001p+1000, InputError::kTooLarge}};
  for (const auto& [value, error] : bad_values) {
    for (Eigen::Index entry = 0; entry < 6; ++entry) {
      Positions bad = good;
      bad(entry / 3, entry % 3) = value;
      EXPECT_EQ(validate(mesh, bad, good), error) << value << " at " << entry;
      EXPECT_EQ(validate(mesh, good, bad), error) << value << " at " << entry;
    }
  }
}

TEST(MakeMesh, TwoTrianglesShareAnEdge) {
  const Mesh mesh = make_mesh(5, faces_of({{0, 1, 2}, {2, 1, 3}}));
  const std::vector<std::array<VertexId, 2>> edges = {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}};
  EXPECT_EQ(mesh.edges, edges);
  const std::vector<std::array<EdgeId, 3>> face_edges = {{2, 1, 0}, {3, 4, 2}};
  EXPECT_EQ(mesh.face_edges, face_edges);
  EXPECT_EQ(mesh.edge_owner, (std::vector<FaceId>{0, 0, 0, 1, 1}));
  EXPECT_EQ(mesh.vertex_owner, (std::vector<FaceId>{0, 0, 0, 1, -1}));
}

TEST(MakeMesh, OfNoFaces) {
  const Mesh mesh = make_mesh(2, std::span<const std::array<VertexId, 3>>());
  EXPECT_TRUE(mesh.faces.empty() && mesh.edges.empty());
  EXPECT_EQ(mesh.vertex_owner, (std::vector<FaceId>{-1, -1}));
}

TEST(MakeMesh, NonManifoldEdgesAndDuplicateFacesAreKept) {
  const Mesh mesh = make_mesh(5, faces_of({{0, 1, 4}, {0, 1, 2}, {1, 0, 3}, {2, 1, 0}}));
  EXPECT_EQ(mesh.faces.size(), 4U);
  EXPECT_EQ(mesh.edges.size(), 7U);  // the shared one, and two more for each of three wings
  EXPECT_EQ(mesh.edges.front(), (std::array<VertexId, 2>{0, 1}));
  EXPECT_EQ(mesh.edge_owner.front(), 0);
}

/// Any index triples, as valid faces: the definition of every array, written the slow way.
TEST(MakeMesh, PropArraysMatchTheirDefinition) {
  testing::check_property(500, 1, [] {
    const auto vertex_count = *rc::gen::inRange<VertexId>(3, 12);
    const auto triples = *rc::gen::container<std::vector<std::array<VertexId, 3>>>(
        rc::gen::suchThat(rc::gen::container<std::array<VertexId, 3>>(rc::gen::inRange<VertexId>(0, vertex_count)),
                          [](const auto& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }));
    const Mesh mesh = make_mesh(vertex_count, faces_of(triples));
    RC_ASSERT(mesh.vertex_count == vertex_count);
    RC_ASSERT(mesh.faces == triples);

    std::map<std::pair<VertexId, VertexId>, FaceId> owner;  // (larger, smaller) -> lowest face
    std::vector<FaceId> vertex_owner(static_cast<std::size_t>(vertex_count), -1);
    for (std::size_t f = triples.size(); f-- > 0;) {
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId a = triples[f][k], b = triples[f][(k + 1) % 3];
        owner[{std::max(a, b), std::min(a, b)}] = static_cast<FaceId>(f);
        vertex_owner[static_cast<std::size_t>(a)] = static_cast<FaceId>(f);
      }
    }
    RC_ASSERT(mesh.vertex_owner == vertex_owner);
    RC_ASSERT(mesh.edges.size() == owner.size());
    RC_ASSERT(mesh.edge_owner.size() == owner.size());
    std::size_t e = 0;
    for (const auto& [key, face] : owner) {
      RC_ASSERT(mesh.edges[e] == (std::array<VertexId, 2>{key.second, key.first}));
      RC_ASSERT(mesh.edge_owner[e] == face);
      ++e;
    }
    for (std::size_t f = 0; f < triples.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& edge = mesh.edges[static_cast<std::size_t>(mesh.face_edges[f][k])];
        const std::set<VertexId> all = {triples[f][k], edge[0], edge[1]};
        RC_ASSERT(all == std::set<VertexId>(triples[f].begin(), triples[f].end()));
        RC_ASSERT(edge[0] != triples[f][k] && edge[1] != triples[f][k]);
      }
    }
  });
}

}  // namespace selvage
