// Contacts in lanes do what friction.h and repulsion do to one pair, with the same bits in any lane on any vector unit.
#include "sim/contact_pack.h"

#include <algorithm>
#include <string>

#include "sim/friction.h"
#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/vector_units.h"

namespace selvage::sim::testing {
namespace {

constexpr double kThickness = 0.25, kStep = 0.125;
constexpr Lanes kAll = 0xff;

/// Eight pairs of one kind, of whose vertices some are not cloth and some lie on a line.
struct EightPairs {
  PairKind kind = integer_in(0, 2) == 0 ? PairKind::kVf : PairKind::kEe;
  std::vector<RandomPair> pairs;
  ContactPack pack;
  LaneVectors x_t1, v, scripted_x, scripted_way;
  double friction_static = number_between(0, 1), friction_kinetic = friction_static * number_between(0, 1);

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
      const bool is_of_kind = contact_of(pair, kThickness).kind == kind;
      if (is_of_kind && effective_mobility(pair.interaction) > 0) return pair;
    }
  }

  void add(std::size_t lane) {
    const RandomPair pair = pair_of_kind();
    const RepulsionContact contact = contact_of(pair, kThickness);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto row = static_cast<std::int32_t>(4 * lane + i);
      const bool is_cloth = pair.inverse_mass[i] > 0;
      pack.vertices[i][lane] = is_cloth ? row : ~row;
      pack.weights[i][lane] = pair.interaction.weights[i];
      pack.mobility[i][lane] = pair.interaction.mobility[i];
      x_t1.row(row) = pair.x_t0[i] + pair.displacement[i];
      v.row(row) = pair.displacement[i] / kStep;
      scripted_x.row(row) = pair.x_t0[i];
      scripted_way.row(row) = pair.displacement[i];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      pack.normal[k][lane] = contact.normal[axis];
      pack.friction_m_s2[k][lane] = number_between(-20, 20);
    }
    pack.thickness_m[lane] = kThickness;
    pack.friction_static[lane] = friction_static;
    pack.friction_kinetic[lane] = friction_kinetic;
    pack.load_m_s2[lane] = integer_in(0, 2) == 0 ? number_between(0, 40) : 0;
    pairs.push_back(pair);
  }

  ContactMotion motion() { return {x_t1, v, scripted_x, scripted_way, kStep, 0, 1}; }

  /// A step of the dynamics, of those given.
  void step(Lanes lanes) {
    PackMotion read;
    read_motion(pack, lanes, motion(), read);
    Lanes loaded = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      if (pack.load_m_s2[lane] > 0) loaded |= static_cast<Lanes>(1U << lane);
    }
    PackNearest nearest;
    find_nearest(kind, read, nearest);
    bear_loads(read, take_nearest(nearest, lanes & loaded, pack), pack, motion());
    read_motion(pack, lanes, motion(), read);
    const Lanes pressed = take_nearest(nearest, newly_pressed(pack, read, lanes), pack);
    press(read, (lanes & loaded) | pressed, 1, true, pack, motion());
    learn_loads(0.5, kStep, pack);
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
      alone.step(static_cast<Lanes>(1U << lane));
      for (Eigen::Index i = 0; i < 4; ++i) {
        const Eigen::Index row = 4 * static_cast<Eigen::Index>(lane) + i;
        RC_ASSERT(alone.v.row(row) == expected.v.row(row));
        RC_ASSERT(alone.x_t1.row(row) == expected.x_t1.row(row));
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
      const RepulsionContact contact = contact_of(pair, kThickness);
      const double displacement = relative(pair.interaction, pair.displacement).dot(contact.normal);
      const double missing = std::min(kThickness - contact.distance - displacement, -displacement);
      PairVectors expected = pair.displacement;
      if (missing > 0) {
        FrictionLoad load;
        load.pressed = lever_share(pair.interaction) * missing;
        expected = sum(expected, distribute(pair.interaction, missing * contact.normal));
        const auto rubs = friction_change(pair.interaction, pair.x_t0, expected, contact.normal,
                                          {eight.friction_static, eight.friction_kinetic}, load);
        if (rubs) expected = sum(expected, *rubs);
      }
      RC_CLASSIFY(missing > 0);
      for (std::size_t i = 0; i < 4; ++i) {
        if (pair.inverse_mass[i] == 0) continue;
        const auto row = static_cast<Eigen::Index>(4 * lane + i);
        RC_ASSERT((kStep * eight.v.row(row).transpose() - expected[i]).norm() <= 1e-9);
        RC_ASSERT((eight.x_t1.row(row).transpose() - pair.x_t0[i] - expected[i]).norm() <= 1e-9);
      }
    }
  });
}

}  // namespace selvage::sim::testing
