// What the user lets touch: which pairs an exemption covers, against the definition spelled out over all faces.
#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "tests/verify/sheet.h"
#include "verify/surface/group_rules.h"
#include "verify/surface/topology.h"
#include "verify/surface/weld.h"

namespace selvage::verify {
namespace {

using selvage::testing::sheet;

bool holds(const FaceSet& set, std::int32_t face) {
  for (const FaceRange& range : set) {
    if (range.begin <= face && face < range.end) return true;
  }
  return false;
}

/// The first exemption of two faces, or -1.
std::int32_t face_rule(const std::vector<Exemption>& exemptions, std::int32_t f, std::int32_t g) {
  for (std::size_t rule = 0; rule < exemptions.size(); ++rule) {
    const auto& [a, b] = exemptions[rule];
    if ((holds(a, f) && holds(b, g)) || (holds(b, f) && holds(a, g))) return static_cast<std::int32_t>(rule);
  }
  return -1;
}

/// A pair is exempt if all pairs of faces that hold the two are, or are of bodies that are not checked; counted under
/// the first rule among them.
std::int32_t pair_rule(const std::vector<Exemption>& exemptions, const std::vector<std::uint8_t>& unchecked_bodies,
                       const std::set<std::int32_t>& faces_x, const std::set<std::int32_t>& faces_y) {
  auto first = static_cast<std::int32_t>(exemptions.size());
  for (const std::int32_t f : faces_x) {
    for (const std::int32_t g : faces_y) {
      const std::int32_t rule = face_rule(exemptions, f, g);
      const bool bodies =
          unchecked_bodies[static_cast<std::size_t>(f)] != 0 && unchecked_bodies[static_cast<std::size_t>(g)] != 0;
      if (rule >= 0 || !bodies) first = std::min(first, rule);
    }
  }
  return first;
}

std::vector<Exemption> random_exemptions(std::mt19937& random, std::int32_t faces) {
  const auto below = [&](std::int32_t n) { return static_cast<std::int32_t>(random() % static_cast<unsigned>(n)); };
  const auto set = [&] {
    FaceSet ranges;
    for (std::int32_t i = below(3); i >= 0; --i) {
      const std::int32_t begin = below(faces);
      ranges.push_back({begin, begin + 1 + below(faces - begin)});
    }
    return ranges;
  };
  std::vector<Exemption> exemptions;
  for (std::int32_t i = below(3); i >= 0; --i) exemptions.push_back({set(), set()});
  return exemptions;
}

template <std::size_t N>
std::vector<std::set<std::int32_t>> holders(const Topology& topology,
                                            const std::vector<std::array<std::int32_t, N>>& elements,
                                            const std::vector<std::uint8_t>& is_ignored) {
  std::vector<std::set<std::int32_t>> result(elements.size());
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (std::size_t f = 0; f < topology.triangles.size(); ++f) {
      if (is_ignored[f] != 0) continue;
      const auto& face = topology.triangles[f];
      const bool all = std::all_of(elements[e].begin(), elements[e].end(),
                                   [&](std::int32_t v) { return v == face[0] || v == face[1] || v == face[2]; });
      if (all) result[e].insert(static_cast<std::int32_t>(f));
    }
  }
  return result;
}

}  // namespace

TEST(Exemptions, CoverAPairOnlyIfTheyCoverAllFacesThatHoldIt) {
  const io::MeshData mesh = sheet(3);
  const auto face_count = static_cast<std::int32_t>(mesh.triangles.size());
  std::vector<std::array<std::int32_t, 1>> vertices;
  for (std::int32_t v = 0; v < 16; ++v) vertices.push_back({v});
  std::mt19937 random(7);
  std::int64_t exempt = 0, owed = 0;
  for (int round = 0; round < 60; ++round) {
    const std::vector<Exemption> exemptions = random_exemptions(random, face_count);
    std::vector<std::uint8_t> is_ignored(mesh.triangles.size());
    for (auto& flag : is_ignored) flag = random() % 5 == 0 ? 1 : 0;
    const bool check_bodies = round % 2 == 0;
    std::vector<std::uint8_t> is_body(mesh.triangles.size());
    for (auto& flag : is_body) flag = random() % 4 == 0 ? 1 : 0;
    const std::vector<std::uint8_t> unchecked_bodies =
        check_bodies ? std::vector<std::uint8_t>(is_body.size(), 0) : is_body;
    const Topology topology = make_topology({mesh.triangles, is_body, is_ignored, exemptions}, mesh.points.size());
    const auto vertex_faces = holders(topology, vertices, is_ignored),
               edge_faces = holders(topology, topology.edges, is_ignored);
    const auto expect_rule = [&](Label x, Label y, const std::set<std::int32_t>& faces_x,
                                 const std::set<std::int32_t>& faces_y) {
      const std::int32_t rule = pair_rule(exemptions, unchecked_bodies, faces_x, faces_y);
      ASSERT_EQ(topology.exemptions.exemption(x, y, check_bodies), rule);
      ++(rule < 0 ? owed : exempt);
    };
    // Of the pairs of these two kinds of parts, two of bodies are left out whatever may touch.
    const auto for_pairs = [&](const Parts& a, const Parts& b, const auto& visit) {
      for (const auto& [x, y] : {std::pair(&a.cloth, &b.cloth), std::pair(&a.cloth, &b.body),
                                 std::pair(&a.body, &b.cloth), std::pair(&a.body, &b.body)}) {
        if (x == &a.body && y == &b.body && !check_bodies) continue;
        for (const std::int32_t i : *x) {
          for (const std::int32_t j : *y) visit(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
        }
      }
    };
    bool owes = false;
    for_pairs(topology.faces, topology.faces, [&](std::size_t f, std::size_t g) {
      const std::int32_t rule = face_rule(exemptions, static_cast<std::int32_t>(f), static_cast<std::int32_t>(g));
      ASSERT_EQ(topology.exemptions.exemption(topology.face_labels[f], topology.face_labels[g], check_bodies), rule);
      owes = owes || (f != g && rule < 0);
    });
    EXPECT_EQ(owes_pairs(topology, check_bodies), owes);
    for_pairs(topology.vertices, topology.faces, [&](std::size_t v, std::size_t f) {
      expect_rule(topology.vertex_labels[v], topology.face_labels[f], vertex_faces[v], {static_cast<std::int32_t>(f)});
    });
    for_pairs(topology.edge_parts, topology.edge_parts, [&](std::size_t d, std::size_t e) {
      expect_rule(topology.edge_labels[d], topology.edge_labels[e], edge_faces[d], edge_faces[e]);
    });
  }
  EXPECT_GT(exempt, 5000);  // neither side of the comparison is empty
  EXPECT_GT(owed, 5000);
}

TEST(Exemptions, AVertexThatAFaceWithoutEdgesHoldsIsOwedWhatThatFaceIs) {
  const std::vector<std::array<std::int32_t, 3>> triangles = {{0, 1, 2}, {3, 4, 5}, {0, 6, 7}};
  const std::vector<std::int32_t> representatives = {0, 1, 2, 3, 4, 5, 0, 0};
  const std::vector<Exemption> exemptions = {{{{0, 1}}, {{1, 2}}}};  // not of the face that is the point 0
  const Topology topology = make_topology({triangles, {}, {}, exemptions, representatives}, 8);
  const auto rule = [&](std::size_t v) {
    return topology.exemptions.exemption(topology.vertex_labels[v], topology.face_labels[1], false);
  };
  EXPECT_EQ(rule(0), -1);
  EXPECT_EQ(rule(1), 0);
}

TEST(Exemptions, WhatOnlyIgnoredFacesHoldIsNoPartOfTheCheck) {
  const std::vector<std::array<std::int32_t, 3>> triangles = {{4, 2, 3}, {0, 3, 2}};
  const std::vector<std::uint8_t> is_ignored = {1, 0};
  const Topology topology = make_topology({triangles, {}, is_ignored}, 6);
  EXPECT_EQ(topology.faces.cloth, (std::vector<std::int32_t>{1}));
  EXPECT_EQ(topology.vertices.cloth, (std::vector<std::int32_t>{0, 2, 3}));
  EXPECT_EQ(topology.edge_parts.cloth.size(), 3U);
  EXPECT_EQ(topology.unreferenced_vertices, 2) << "an ignored face still holds its vertices";
}

TEST(GroupRules, ThatCannotBeMeantAreErrorsThatNameTheGroups) {
  const std::vector<io::Group> groups = {{"shirt", io::Group::Role::kCloth, 0, 5},
                                         {"button", io::Group::Role::kCloth, 5, 6},
                                         {"empty", io::Group::Role::kCloth, 6, 6}};
  const auto message = [&](const GroupRules& rules) -> std::string {
    try {
      (void)resolve(rules, groups, 8);
    } catch (const GroupRuleError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({{}, {{"shirt", "button"}}, {"button"}}), "");
  for (const GroupRules& bad : {GroupRules{{}, {{"shirt", "pants"}}, {}}, GroupRules{{}, {}, {"pants"}},
                                GroupRules{{}, {{"empty", "shirt"}}, {}}, GroupRules{{}, {{"button", "button"}}, {}}}) {
    EXPECT_NE(message(bad).find("\"shirt\" (5 faces)"), std::string::npos) << message(bad);
  }
  for (const io::Group& range :
       {io::Group{"x", io::Group::Role::kCloth, 3, 9}, io::Group{"x", io::Group::Role::kCloth, 3, 3},
        io::Group{"x", io::Group::Role::kCloth, -1, 3}}) {
    EXPECT_NE(message({{range}, {}, {}}), "");
  }
  const ResolvedRules twice = resolve({{{"shirt", io::Group::Role::kCloth, 4, 8}}, {}, {"shirt"}}, groups, 8);
  EXPECT_EQ(twice.ignored_faces, (std::vector<std::int64_t>{8})) << "equal names are one group, and a face counts once";
}

TEST(Weld, AFaceThatCollapsesKeepsThreeNamesForTheSamePoints) {
  const std::vector<std::int32_t> representatives = {0, 1, 2, 0, 0, 0, 1};
  const std::vector<std::array<std::int32_t, 3>> faces = {{3, 6, 2}, {3, 0, 2}, {3, 2, 4}, {3, 4, 5}, {5, 4, 0}};
  const WeldedFaces welded = weld_faces(faces, representatives);
  EXPECT_EQ(welded.triangles[0], (std::array<std::int32_t, 3>{0, 1, 2}));
  EXPECT_EQ(welded.collapsed, (std::vector<std::int32_t>{1, 2, 3, 4}));
  for (const std::int32_t f : welded.collapsed) {
    const auto &face = welded.triangles[std::size_t(f)], &original = faces[std::size_t(f)];
    EXPECT_EQ(std::set<std::int32_t>(face.begin(), face.end()).size(), 3U) << f;
    EXPECT_EQ(std::count(face.begin(), face.end(), 0), 1) << f << ": by it the face is known to its neighbours";
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(representatives[std::size_t(face[i])], representatives[std::size_t(original[i])]) << f;
    }
  }
}

TEST(Weld, JoinsWhatNeverParts) {
  const Point p = {1, 2, 3}, q = {4, 5, 6};
  Weld weld;
  weld.narrow(std::vector<Point>{p, q, p, q, p, {0.0, 0, 0}, {-0.0, 0, 0}});
  EXPECT_EQ(weld.representatives(), (std::vector<std::int32_t>{0, 1, 0, 1, 0, 5, 5}))
      << "-0 has other bits and is the same number: garments that were mirrored hold it at their seam";
  weld.narrow(std::vector<Point>{q, q, q, q, p, p, p});
  EXPECT_EQ(weld.representatives(), (std::vector<std::int32_t>{0, 1, 0, 1, 4, 5, 5})) << "0 and 1 met too late";
  weld.narrow(std::vector<Point>{q, p, p, p, p, {0, -0.0, 5e-324}, {0, 0.0, -5e-324}});
  EXPECT_EQ(weld.representatives(), (std::vector<std::int32_t>{0, 1, 2, 1, 4, 5, 6})) << "not zeros";
  EXPECT_THROW(weld.narrow(std::vector<Point>{p}), std::invalid_argument);
}

}  // namespace selvage::verify
