#include "sim/dynamics/contact_sweeps.h"

#include <gtest/gtest.h>

#include "tests/sim/dynamics/swept_contact_scenes.h"

namespace selvage::sim::testbed {
namespace {

/// Faces that touch nowhere, each of one mass, and contacts among them.
struct Pieces {
  std::vector<double> inverse_mass;
  Faces faces;
  std::vector<RepulsionContact> contacts;

  /// Each of vertices with the inverse mass.
  explicit Pieces(const std::vector<double>& inverse_masses) : faces(std::ssize(inverse_masses), 3) {
    for (std::int32_t face = 0; face < faces.rows(); ++face) {
      faces.row(face) << 3 * face, 3 * face + 1, 3 * face + 2;
      inverse_mass.insert(inverse_mass.end(), 3, inverse_masses[static_cast<std::size_t>(face)]);
    }
  }
  /// The first vertex of a face on another, or their first edges.
  void meet(VertexId face, VertexId other, PairKind kind = PairKind::kVf) {
    RepulsionContact contact;
    contact.kind = kind;
    const bool is_vf = kind == PairKind::kVf;
    const std::array<VertexId, 4> vertices{3 * face, is_vf ? 3 * other : 3 * face + 1, 3 * other + (is_vf ? 1 : 0),
                                           3 * other + (is_vf ? 2 : 1)};
    contact.interaction = make_interaction(kind, vertices, {}, inverse_mass);
    contacts.push_back(contact);
  }
  [[nodiscard]] std::vector<std::int32_t> sweeps(std::int32_t least = 1) const {
    return contact_sweeps(contacts, VertexFaces(make_mesh(static_cast<std::int32_t>(inverse_mass.size()), faces)),
                          least);
  }
};

using Sweeps = std::vector<std::int32_t>;

/// Of one contact.
std::int32_t sweeps_of(double inverse_mass, double other, PairKind kind = PairKind::kVf, std::int32_t least = 1) {
  Pieces pieces({inverse_mass, other});
  pieces.meet(0, 1, kind);
  const Sweeps sweeps = pieces.sweeps(least);
  return sweeps.empty() ? least : sweeps[0];
}

TEST(ContactSweeps, MassesThatAreAlikeTakeTheLeast) {
  Pieces pieces({1, 1, 4, 2});
  pieces.meet(0, 1);
  pieces.meet(1, 2);
  pieces.meet(3, 0, PairKind::kEe);
  EXPECT_TRUE(pieces.sweeps().empty());
  EXPECT_TRUE(pieces.sweeps(4).empty());
}

TEST(ContactSweeps, RiseWithTheRatioOfTheMasses) {
  for (const PairKind kind : {PairKind::kVf, PairKind::kEe}) {
    EXPECT_EQ(sweeps_of(1, 4, kind), 1);
    EXPECT_EQ(sweeps_of(1, 4.1, kind), 3);
    EXPECT_EQ(sweeps_of(1, 100, kind), 19);
    EXPECT_EQ(sweeps_of(100, 1, kind), 19) << "whichever is heavier";
    EXPECT_EQ(sweeps_of(1e-3, 0.1, kind), 19) << "in whatever units";
    EXPECT_EQ(sweeps_of(1, 256, kind), 31);
    EXPECT_EQ(sweeps_of(1, 1e9, kind), 31);
    std::int32_t before = 1;
    for (double ratio = 1; ratio < 1e4; ratio *= 1.1) {
      const std::int32_t now = sweeps_of(1, ratio, kind);
      EXPECT_GE(now, before) << ratio;
      EXPECT_EQ((now - 1) % 2, 0) << ratio;
      before = now;
    }
  }
}

TEST(ContactSweeps, AreNoFewerThanTheSceneAsksFor) {
  EXPECT_EQ(sweeps_of(1, 100, PairKind::kVf, 4), 20);
  EXPECT_EQ(sweeps_of(1, 1e9, PairKind::kVf, 4), kMaxUnlikeSweeps);
  EXPECT_EQ(sweeps_of(1, 1e9, PairKind::kVf, 50), 50);
}

TEST(ContactSweeps, BesideUnlikeMassesHalfAsManyMore) {
  // A body, three veils and a carpet.
  Pieces pieces({0, 1, 1, 1, 1.0 / 100});
  pieces.meet(1, 0);  // the lowest veil on the body
  pieces.meet(2, 1);
  pieces.meet(3, 2);
  pieces.meet(4, 3);
  EXPECT_EQ(pieces.sweeps(), (Sweeps{1, 1, 9, 19}));
  pieces.contacts.erase(pieces.contacts.end() - 2);  // which connected them
  EXPECT_EQ(pieces.sweeps(), (Sweeps{1, 1, 19}));
}

TEST(ContactSweeps, WhatCannotMoveHasNoMassAndConnectsNothing) {
  // A body under a light and a heavy cloth, which touch nowhere; then they do.
  Pieces pieces({0, 1, 1.0 / 100});
  pieces.meet(1, 0);
  pieces.meet(2, 0);
  EXPECT_TRUE(pieces.sweeps().empty());
  pieces.meet(1, 2);
  EXPECT_EQ(pieces.sweeps(), (Sweeps{9, 9, 19}));

  // Pinned corners of a face count for nothing.
  Pieces pinned({1, 0.5});
  pinned.inverse_mass[3] = pinned.inverse_mass[4] = 0;
  pinned.meet(0, 1);
  EXPECT_TRUE(pinned.sweeps().empty());
}

TEST(ContactSweeps, OneClothIsAlikeHoweverItsMassIsSharedOut) {
  // A fan of six faces, whose middle lies on the corner of another cloth, which has one face there.
  Pieces pieces({1, 1, 1, 1, 1, 1, 1});
  for (std::int32_t face = 1; face < 7; ++face) pieces.faces(face, 0) = 3;
  pieces.contacts.resize(1);
  const auto sweeps_of_middle = [&](double inverse_mass) {
    std::vector<double> masses = pieces.inverse_mass;
    masses[3] = inverse_mass;
    pieces.contacts[0].interaction = make_interaction(PairKind::kVf, {3, 0, 1, 2}, {}, masses);
    return pieces.sweeps();
  };
  EXPECT_TRUE(sweeps_of_middle(1).empty()) << "equally";
  EXPECT_TRUE(sweeps_of_middle(1.0 / 6).empty()) << "by its faces";
  EXPECT_EQ(sweeps_of_middle(1.0 / 30), (Sweeps{3})) << "five times as heavy for its faces, 30 times as it is";
}

}  // namespace
}  // namespace selvage::sim::testbed
