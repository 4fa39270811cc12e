// Candidate positions for a step: how a simulator, or an enemy, would like the vertices to be.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "fuzz/draw/step_world.h"

namespace selvage::fuzz {
namespace {

Vec3 choose_vector(ChoiceSource& source) { return {source.signed_real(), source.signed_real(), source.signed_real()}; }

/// Row by row: the order in which Eigen adds up a column depends on the address that the result has.
Eigen::RowVector3d centre_of(const Positions& x) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (const auto& point : x.rowwise()) sum += point;
  return sum / static_cast<double>(x.rows());
}

Positions still(ChoiceSource& /*source*/, const StepWorld& /*world*/, const Positions& x) { return x; }

/// Every vertex by up to `size`, each for itself.
Positions jolt(ChoiceSource& source, const Positions& x, double size) {
  Positions candidate = x;
  ChoiceSource noise = ChoiceSource::from_seed(source.n(1U << 16));
  for (double& coordinate : candidate.reshaped()) coordinate += size * noise.signed_real();
  return candidate;
}
Positions small_jolt(ChoiceSource& source, const StepWorld& world, const Positions& x) {
  return jolt(source, x, world.gap_m * std::ldexp(1.0, -source.range(0, 20)));
}
Positions wild_jolt(ChoiceSource& source, const StepWorld& world, const Positions& x) {
  return jolt(source, x, world.spacing_m * std::ldexp(1.0, source.range(-2, 12)));
}

/// As a falling cloth: one velocity, and a gradient of it.
Positions smooth(ChoiceSource& source, const StepWorld& world, const Positions& x) {
  const double size = world.gap_m * std::ldexp(1.0, source.range(-4, 8));
  const Vec3 along = choose_vector(source);
  const Vec3 normal = choose_vector(source);
  Positions candidate = x;
  const Eigen::RowVector3d centre = centre_of(x);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double phase = (x.row(i) - centre).dot(normal) / world.spacing_m;
    const double wave = std::abs(phase - std::floor(phase) - 0.5) - 0.25;  // no libm: the same bits everywhere
    candidate.row(i) += size * wave * along.transpose();
  }
  return candidate;
}

/// Each layer takes the place of another: x -> 2 centre - x along one axis, so that all orders are reversed.
Positions swap_layers(ChoiceSource& source, const StepWorld& /*world*/, const Positions& x) {
  const int axis = 2 - source.range(0, 2);
  Positions candidate = x;
  candidate.col(axis).array() = 2 * centre_of(x)[axis] - x.col(axis).array();
  return candidate;
}

Positions to_point(ChoiceSource& source, const StepWorld& /*world*/, const Positions& x) {
  const Eigen::RowVector3d target = source.coin() ? Eigen::RowVector3d(x.row(0)) : centre_of(x);
  return target.replicate(x.rows(), 1);
}

Positions to_plane(ChoiceSource& source, const StepWorld& /*world*/, const Positions& x) {
  const int axis = 2 - source.range(0, 2);
  Positions candidate = x;
  candidate.col(axis).setConstant(centre_of(x)[axis]);
  return candidate;
}

/// About the centre, by a factor that may be negative (inside out) or enormous.
Positions explode(ChoiceSource& source, const StepWorld& /*world*/, const Positions& x) {
  const int exponent = source.range(0, 40);
  const double factor = std::ldexp(source.coin() ? -1.0 : 1.0, exponent);
  const Eigen::RowVector3d centre = centre_of(x);
  return (factor * (x.rowwise() - centre)).rowwise() + centre;
}

/// Vertices change places: many exact coincidences.
Positions permute(ChoiceSource& source, const StepWorld& /*world*/, const Positions& x) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(x.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  ChoiceSource shuffler = ChoiceSource::from_seed(source.n(1U << 16));
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[shuffler.n(static_cast<std::uint32_t>(i))]);
  Positions candidate = x;
  for (Eigen::Index i = 0; i < x.rows(); ++i) candidate.row(i) = x.row(order[static_cast<std::size_t>(i)]);
  return candidate;
}

Positions throw_one(ChoiceSource& source, const StepWorld& world, const Positions& x) {
  Positions candidate = x;
  const auto vertex = static_cast<Eigen::Index>(source.n(static_cast<std::uint32_t>(x.rows())));
  const double size = world.spacing_m * std::ldexp(1.0, source.range(-4, 10));
  candidate.row(vertex) += size * choose_vector(source).transpose();
  return candidate;
}

/// Any double of the domain.
Positions anywhere(ChoiceSource& source, const StepWorld& /*world*/, const Positions& x) {
  ChoiceSource noise = ChoiceSource::from_seed(source.n(1U << 16));
  Positions candidate = x;
  for (double& coordinate : candidate.reshaped()) {
    const int exponent = noise.range(-1074, 999);
    coordinate = std::ldexp(noise.signed_real(), exponent);
  }
  return candidate;
}

struct CandidateClass {
  std::string_view name;
  Positions (*make)(ChoiceSource&, const StepWorld&, const Positions&);
};
constexpr std::array<CandidateClass, kCandidateClassCount> kCandidateClasses{{{"still", still},
                                                                              {"small-jolt", small_jolt},
                                                                              {"smooth", smooth},
                                                                              {"throw-one", throw_one},
                                                                              {"swap-layers", swap_layers},
                                                                              {"to-plane", to_plane},
                                                                              {"to-point", to_point},
                                                                              {"explode", explode},
                                                                              {"permute", permute},
                                                                              {"wild-jolt", wild_jolt},
                                                                              {"anywhere", anywhere}}};

/// A script that leaves the domain would be refused, rightly.
bool is_in_domain(const Eigen::RowVector3d& point) { return point.cwiseAbs().maxCoeff() <= kMaxCoordinate; }

/// A body moves as a whole: with the candidate displacement of its first vertex, or not at all where that leaves the
/// domain. Pinned vertices stay.
void move_bodies_rigidly(const StepWorld& world, const Positions& x, Positions& candidate) {
  std::vector<Eigen::Index> first;  // vertex of each body
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const std::int32_t body = world.body[static_cast<std::size_t>(i)];
    if (body < 0) {
      if (world.is_scripted(static_cast<std::int32_t>(i))) candidate.row(i) = x.row(i);
      continue;
    }
    const auto place = static_cast<std::size_t>(body);
    if (first.size() <= place) first.resize(place + 1, -1);
    if (first[place] < 0) {
      first[place] = i;
      if (!is_in_domain(candidate.row(i))) candidate.row(i) = x.row(i);
      continue;
    }
    const Eigen::Index leader = first[place];
    const Eigen::RowVector3d target = x.row(i) + (candidate.row(leader) - x.row(leader));
    candidate.row(i) = is_in_domain(target) ? target : Eigen::RowVector3d(x.row(i));
  }
}

}  // namespace

Positions choose_candidate(ChoiceSource& source, const StepWorld& world, const Positions& x,
                           std::string_view& candidate_class) {
  const CandidateClass& chosen = kCandidateClasses[source.n(kCandidateClasses.size())];
  candidate_class = chosen.name;
  Positions candidate = chosen.make(source, world, x);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    if (!candidate.row(i).allFinite()) candidate.row(i) = x.row(i);
  }
  move_bodies_rigidly(world, x, candidate);
  return candidate;
}

}  // namespace selvage::fuzz
