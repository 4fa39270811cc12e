// Contacts in lanes do what friction.h and repulsion do to one pair, with the same bits in any lane on any vector unit.
#include "sim/dynamics/contact_pack.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/response/friction.h"
#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/vector_units.h"

namespace selvage::sim::testbed {
namespace {

constexpr double kPackThickness = 0.25, kPackStep = 0.125;
constexpr LaneMask kAll = 0xff;

/// Eight pairs of one kind, of whose vertices some are not cloth and some lie on a line.
struct EightPairs {
  PairKind kind = integer_in(0, 2) == 0 ? PairKind::kVf : PairKind::kEe;
  std::vector<RandomPair> pairs;
  ContactPack pack;
  LaneVectors x_t1, v, scripted_x, scripted_way;
  double friction_static = number_between(0, 1), friction_kinetic = friction_static * number_between(0, 1);
  double creep_m = integer_in(0, 2) * number_between(0, 2);

  EightPairs() {
    for (LaneVectors* rows : {&x_t1, &v, &scripted_x, &scripted_way}) rows->resize(4 * kLanes);
    for (std::size_t lane = 0; lane < kLanes; ++lane) add(lane);
  }

  [[nodiscard]] RandomPair pair_of_kind() const {
    for (;;) {
      RandomPair pair = integer_in(0, 2) == 0 ? random_pair(true) : random_contact(number_between(1e-3, 0.4));
      if (integer_in(0, 8) == 0) {
        for (Vec3& x : pair.x_t0) x = x.z() * Vec3(1, 2, 3);
      }
      const bool is_of_kind = contact_of(pair, kPackThickness).kind == kind;
      if (is_of_kind && effective_mobility(pair.interaction) > 0) return pair;
    }
  }

  void add(std::size_t lane) {
    const RandomPair pair = pair_of_kind();
    const RepulsionContact contact = contact_of(pair, kPackThickness);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto row = static_cast<std::int32_t>(4 * lane + i);
      const bool is_cloth = pair.inverse_mass[i] > 0;
      pack.vertices[i][lane] = is_cloth ? row : ~row;
      pack.weights[i][lane] = pair.interaction.weights[i];
      pack.mobility[i][lane] = pair.interaction.mobility[i];
      x_t1.row(row) = pair.x_t0[i] + pair.displacement[i];
      v.row(row) = pair.displacement[i] / kPackStep;
      scripted_x.row(row) = pair.x_t0[i];
      scripted_way.row(row) = pair.displacement[i];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      pack.normal[k][lane] = contact.normal[axis];
      pack.friction_m_s2[k][lane] = number_between(-20, 20);
    }
    pack.thickness_m[lane] = kPackThickness;
    pack.friction_static[lane] = friction_static;
    pack.friction_kinetic[lane] = friction_kinetic;
    pack.load_m_s2[lane] = integer_in(0, 2) == 0 ? number_between(0, 40) : 0;
    pairs.push_back(pair);
  }

  ContactMotion motion() { return {x_t1, v, scripted_x, scripted_way, kPackStep, 0, 1, creep_m}; }

  /// A step of the dynamics, of those given.
  void step(LaneMask lanes) {
    PackMotion read;
    read_motion(pack, lanes, motion(), read);
    LaneMask loaded = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (pack.load_m_s2[lane] > 0) loaded |= only_lane(lane);
    }
    PackNearest nearest;
    find_nearest(kind, read, nearest);
    bear_loads(read, take_nearest(nearest, lanes & loaded, pack), pack, motion());
    read_motion(pack, lanes, motion(), read);
    const LaneMask pressed = take_nearest(nearest, newly_pressed(pack, read, lanes), pack);
    press(read, (lanes & loaded) | pressed, 1, true, pack, motion());
    learn_loads(kind, 0.5, kPackStep, pack);
  }
};

/// Not shrunk: that would look for another kind of pair for ever.
EightPairs eight_pairs() {
  return *rc::gen::noShrink(rc::gen::exec([] { return EightPairs(); }));
}

std::vector<double> numbers_of(const EightPairs& eight) {
  std::vector<double> result;
  for (Eigen::Index i = 0; i < eight.v.rows(); ++i) {
    for (int k = 0; k < 3; ++k) {
      result.push_back(eight.v.axis(k)[i]);
      result.push_back(eight.x_t1.axis(k)[i]);
    }
  }
  const auto add = [&](const auto& column) { result.insert(result.end(), column.begin(), column.end()); };
  std::ranges::for_each(eight.pack.weights, add);
  std::ranges::for_each(eight.pack.normal, add);
  std::ranges::for_each(eight.pack.friction_m_s2, add);
  add(eight.pack.load_m_s2);
  result.push_back(eight.pack.ever_repelled);
  result.push_back(eight.pack.ever_rubbed);
  return result;
}

}  // namespace

TEST(ContactPack, PropGivesTheSameBitsInAnyLaneOnAnyVectorUnit) {
  selvage::testing::check_property(200, 41, [] {
    const EightPairs eight = eight_pairs();
    EightPairs expected = eight;
    expected.step(kAll);
    std::vector<std::string> wrong;
    selvage::testing::on_every_vector_unit([&](const char* unit) {
      EightPairs at_once = eight;
      at_once.step(kAll);
      if (numbers_of(at_once) != numbers_of(expected)) wrong.emplace_back(unit);
    });
    RC_ASSERT(wrong == std::vector<std::string>{});
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      EightPairs alone = eight;
      alone.step(only_lane(lane));
      for (Eigen::Index i = 0; i < 4; ++i) {
        const Eigen::Index row = 4 * static_cast<Eigen::Index>(lane) + i;
        RC_ASSERT(alone.v.row(row) == expected.v.row(row));
        RC_ASSERT(alone.x_t1.row(row) == expected.x_t1.row(row));
      }
    }
  });
}

// Without a bow on a straight line, with it a quarter of that beside the middle.
TEST(ContactPack, PropWhatIsNotClothGoesOnItsParabola) {
  selvage::testing::check_property(100, 45, [] {
    EightPairs eight = eight_pairs();
    LaneVectors bow;
    bow.copy(Positions::Random(4 * kLanes, 3));
    const double share = number_between(0, 0.5), step_share = number_between(0, 0.5);
    const auto place = [&](Eigen::Index row, double s, bool bends) -> Vec3 {
      return eight.scripted_x.row(row) + s * eight.scripted_way.row(row) - (bends ? s * (1 - s) : 0) * bow.row(row);
    };
    for (const bool bends : {false, true}) {
      ContactMotion motion = eight.motion();
      motion.share = share;
      motion.step_share = step_share;
      motion.scripted_bow = bends ? &bow : nullptr;
      PackMotion read;
      read_motion(eight.pack, kAll, motion, read);
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
          if (eight.pack.vertices[i][lane] >= 0) continue;
          const auto row = static_cast<Eigen::Index>(~eight.pack.vertices[i][lane]);
          const Vec3 from = place(row, share, bends), to = place(row, share + step_share, bends);
          for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<Eigen::Index>(k);
            RC_ASSERT(std::abs(read.x[i][k][lane] - from[axis]) < 1e-13);
            RC_ASSERT(std::abs(read.x[i][k][lane] + read.displacement[i][k][lane] - to[axis]) < 1e-13);
          }
        }
      }
    }
  });
}

TEST(ContactPack, PropPressesAndRubsAsOnePairDoes) {
  selvage::testing::check_property(300, 43, [] {
    EightPairs eight = eight_pairs();
    for (std::size_t lane = 0; lane < kLanes; ++lane) eight.pack.load_m_s2[lane] = 0;
    PackMotion read;
    read_motion(eight.pack, kAll, eight.motion(), read);
    press(read, kAll, 1, true, eight.pack, eight.motion());
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const RandomPair& pair = eight.pairs[lane];
      const RepulsionContact contact = contact_of(pair, kPackThickness);
      const double displacement = relative(pair.interaction, pair.displacement).dot(contact.normal);
      const double missing = std::min(kPackThickness - contact.distance - displacement, -displacement);
      PairVectors expected = pair.displacement;
      if (missing > 0) {
        FrictionLoad load;
        load.pressed = lever_share(pair.interaction) * missing;
        expected = sum(expected, distribute(pair.interaction, missing * contact.normal));
        const auto rubs = friction_change(pair.interaction, pair.x_t0, expected, contact.normal,
                                          {eight.friction_static, eight.friction_kinetic, eight.creep_m}, load);
        if (rubs) expected = sum(expected, *rubs);
      }
      RC_CLASSIFY(missing > 0);
      for (std::size_t i = 0; i < 4; ++i) {
        if (pair.inverse_mass[i] == 0) continue;
        const auto row = static_cast<Eigen::Index>(4 * lane + i);
        RC_ASSERT((kPackStep * eight.v.row(row).transpose() - expected[i]).norm() <= 1e-9);
        RC_ASSERT((eight.x_t1.row(row).transpose() - pair.x_t0[i] - expected[i]).norm() <= 1e-9);
      }
    }
  });
}

namespace {

/// Lane 5 of a pack: the vertices of a pair, all of cloth or, without mobility, not, at rest; `pressed` in a step.
struct OnePair {
  static constexpr std::size_t kLane = 5;
  ContactPack pack;
  LaneVectors x_t1, v, none;
  PairVectors x_t0;

  OnePair(const Interaction& interaction, const PairVectors& x, double pressed) : x_t0(x) {
    for (LaneVectors* rows : {&x_t1, &v, &none}) rows->resize(4);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto row = static_cast<std::int32_t>(i);
      pack.vertices[i][kLane] = interaction.mobility[i] > 0 ? row : ~row;
      pack.weights[i][kLane] = interaction.weights[i];
      pack.mobility[i][kLane] = interaction.mobility[i];
      x_t1.row(row) = x[i];
    }
    pack.normal[2][kLane] = 1;
    pack.load_m_s2[kLane] = pressed / (kPackStep * kPackStep);
  }
  void set_friction(double most, const Vec3& friction_m) {
    pack.friction_static[kLane] = pack.friction_kinetic[kLane] = most;
    for (std::size_t k = 0; k < 3; ++k) {
      pack.friction_m_s2[k][kLane] = friction_m[static_cast<Eigen::Index>(k)] / (kPackStep * kPackStep);
    }
  }
  PackMotion read() {
    PackMotion result;
    read_motion(pack, only_lane(kLane), {x_t1, v, none, none, kPackStep, 0, 1}, result);
    return result;
  }
  void bear() { bear_loads(read(), only_lane(kLane), pack, {x_t1, v, none, none, kPackStep, 0, 1}); }
  [[nodiscard]] Vec3 moved(std::size_t i) const { return kPackStep * v.row(static_cast<Eigen::Index>(i)).transpose(); }
  [[nodiscard]] Vec3 rubbed() const { return {pack.rubbed[0][kLane], pack.rubbed[1][kLane], pack.rubbed[2][kLane]}; }
};

}  // namespace

TEST(ContactPack, FrictionBeginsAcrossTheNormalWithinTheStaticCone) {
  const Interaction interaction =
      make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 0.25, 0.25, 0.5}, std::array<double, 4>{1, 0, 0, 0});
  const PairVectors x{Vec3(0, 0, 0.5), Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 1, 0)};
  const auto moves = [&](const Vec3& friction_m) {
    OnePair one(interaction, x, 2);
    one.set_friction(0.5, friction_m);
    one.bear();
    return one.moved(0);
  };
  EXPECT_LT((moves(Vec3(0.3, -0.4, 7)) - Vec3(0.3, -0.4, 2)).norm(), 1e-14);
  EXPECT_LT((moves(Vec3(3, -4, 7)) - Vec3(0.6, -0.8, 2)).norm(), 1e-14);
  EXPECT_EQ(moves(Vec3(0, 0, 7)), Vec3(0, 0, 2));
}

TEST(ContactPack, PropFrictionBeginsWithNoMoreEnergyThanItsImpulseHas) {
  // Where masses differ by more than doubles hold.
  constexpr double kPressed = 1e-6;  // little beside what rubs
  int begun = 0;
  selvage::testing::check_property(2000, 47, [&] {
    const RandomPair pair = contact_of_extreme_masses();
    RC_PRE(lever_share(pair.interaction) == 1);
    OnePair one(pair.interaction, pair.x_t0, kPressed);
    one.set_friction(1e9, Vec3(number_between(-1, 1), number_between(-1, 1), 0));
    one.bear();
    begun += one.rubbed().norm() > 0 ? 1 : 0;
    double energy = 0;
    for (std::size_t i = 0; i < 4; ++i) energy += one.moved(i).squaredNorm() / pair.interaction.mobility[i];
    const double mobility = effective_mobility(pair.interaction);
    RC_ASSERT(energy <= (1 + 1e-9) * (kPressed * kPressed / mobility + mobility * one.rubbed().squaredNorm()));
  });
  EXPECT_GT(begun, 100);
}

TEST(ContactPack, PropFrictionAddsNoEnergy) {
  // Where masses differ by more than doubles hold; of the motion beside the heaviest vertex, as in friction_test.cpp.
  int rubbed = 0;
  selvage::testing::check_property(2000, 53, [&] {
    const RandomPair pair = contact_of_extreme_masses();
    OnePair one(pair.interaction, pair.x_t0, 0);
    const double friction = std::pow(10, number_between(0, 12));
    one.set_friction(friction, Vec3::Zero());
    one.pack.pressed[OnePair::kLane] = 1;
    PairVectors level = pair.displacement;
    for (Vec3& d : level) d.z() = 0;  // so that nothing is pressed more or less
    one.pack.thickness_m[OnePair::kLane] = relative(pair.interaction, pair.x_t0).z();
    for (std::size_t i = 0; i < 4; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      one.v.row(row) = level[i] / kPackStep;
      one.x_t1.row(row) = pair.x_t0[i] + level[i];
    }
    press(one.read(), only_lane(OnePair::kLane), 1, true, one.pack,
          {one.x_t1, one.v, one.none, one.none, kPackStep, 0, 1});
    if (one.rubbed() == Vec3::Zero()) return;
    ++rubbed;
    const auto& mobility = pair.interaction.mobility;
    const auto heaviest = static_cast<std::size_t>(std::ranges::min_element(mobility) - mobility.begin());
    double before = 0, after = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      before += (level[i] - level[heaviest]).squaredNorm() / mobility[i];
      after += (one.moved(i) - level[heaviest]).squaredNorm() / mobility[i];
    }
    RC_ASSERT(after <= before * (1 + 1e-9));
  });
  EXPECT_GT(rubbed, 500);
}

}  // namespace selvage::sim::testbed
