#include "sim/springs/scripted_drive.h"

#include <algorithm>
#include <optional>

#include "sim/base/disjoint_sets.h"
#include "sim/base/share_within.h"
#include "sim/base/sorted_once.h"

namespace selvage::sim {
namespace {

/// Over the fastest that is moved. Chosen, not derived: a chain that is pushed together bends at 0.7 to 5 times that
/// without limits (docs/measurements/numerics.md, *Limits on strain*), and the less, the less a limit makes of a
/// toggle.
constexpr double kDriven = 2;

bool is_moved(double inverse_mass) { return inverse_mass == 0; }

bool moves_against_each_other(const LaneVectors& v, const std::vector<BoundedPair>& pairs) {
  std::optional<Vec3> first;
  const auto differs = [&](VertexId vertex, double inverse_mass) {
    if (!is_moved(inverse_mass)) return false;
    const Vec3 own = v.row(vertex).transpose();
    if (!first) first = own;
    return own != *first;
  };
  return std::ranges::any_of(pairs, [&](const BoundedPair& pair) {
    return differs(pair.a, pair.inverse_mass_a) || differs(pair.b, pair.inverse_mass_b);
  });
}

/// The vertices of pairs, and which of them hang together by vertices that can move.
class Sets {
 public:
  explicit Sets(const std::vector<BoundedPair>& pairs) : vertices_(vertices_of(pairs)), sets_(vertices_.size()) {
    for (const BoundedPair& pair : pairs) {
      if (is_moved(pair.inverse_mass_a) || is_moved(pair.inverse_mass_b)) continue;
      sets_.join(place_of(pair.a), place_of(pair.b));
    }
  }
  [[nodiscard]] std::size_t size() const { return vertices_.size(); }
  [[nodiscard]] std::size_t place_of(VertexId vertex) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(vertices_, vertex) - vertices_.begin());
  }
  [[nodiscard]] std::size_t of(const BoundedPair& pair) {
    return sets_.root(place_of(is_moved(pair.inverse_mass_a) ? pair.b : pair.a));
  }

 private:
  static std::vector<VertexId> vertices_of(const std::vector<BoundedPair>& pairs) {
    std::vector<VertexId> vertices;
    for (const BoundedPair& pair : pairs) {
      vertices.push_back(pair.a);
      vertices.push_back(pair.b);
    }
    keep_sorted_once(vertices);
    return vertices;
  }

  std::vector<VertexId> vertices_;  ///< sorted
  DisjointSets<std::size_t> sets_;  ///< of places in vertices_
};

struct Drive {
  std::optional<Vec3> first;      ///< velocity of what is moved
  Vec3 beside_it = Vec3::Zero();  ///< sum of how all that is moved moves beside that, once for each pair
  double count = 0;
  double moved_m_s = 0, free_m_s = 0;  ///< the fastest beside the mean
  double share = 1;
  [[nodiscard]] Vec3 mean() const { return *first + beside_it / count; }  // exact where all move alike
  [[nodiscard]] double allowed_m_s() const { return std::max(kDriven * moved_m_s, free_m_s); }
};

}  // namespace

void limit_drive(const LaneVectors& v, std::vector<BoundedPair>& pairs) {
  if (!moves_against_each_other(v, pairs)) return;
  Sets sets(pairs);
  std::vector<Drive> drives(sets.size());
  std::vector<Vec3> change(sets.size(), Vec3::Zero());
  const auto each_end = [&](auto visit) {
    for (const BoundedPair& pair : pairs) {
      Drive& drive = drives[sets.of(pair)];
      visit(drive, pair.a, pair.inverse_mass_a, Vec3(pair.change_n_s * pair.direction));
      visit(drive, pair.b, pair.inverse_mass_b, Vec3(-pair.change_n_s * pair.direction));
    }
  };
  each_end([&](Drive& drive, VertexId vertex, double w, const Vec3& impulse) {
    change[sets.place_of(vertex)] += w * impulse;
    if (!is_moved(w)) return;
    if (!drive.first) drive.first = v.row(vertex).transpose();
    drive.beside_it += v.row(vertex).transpose() - *drive.first;
    drive.count += 1;
  });
  each_end([&](Drive& drive, VertexId vertex, double w, const Vec3&) {
    if (!drive.first) return;
    double& fastest_m_s = is_moved(w) ? drive.moved_m_s : drive.free_m_s;
    fastest_m_s = std::max(fastest_m_s, (v.row(vertex).transpose() - drive.mean()).norm());
  });
  each_end([&](Drive& drive, VertexId vertex, double w, const Vec3&) {
    if (!(drive.moved_m_s > 0) || is_moved(w)) return;
    const Vec3 start = v.row(vertex).transpose() - drive.mean();
    const double allowed_m_s = drive.allowed_m_s();
    const double room = std::max(0.0, allowed_m_s * allowed_m_s - start.squaredNorm());
    drive.share = std::min(drive.share, share_within(start, change[sets.place_of(vertex)], room));
  });
  for (BoundedPair& pair : pairs) {
    const double left_out = (1 - drives[sets.of(pair)].share) * pair.change_n_s;
    pair.change_n_s -= left_out;
    pair.impulse_n_s = std::max(0.0, pair.impulse_n_s - left_out);
  }
}

}  // namespace selvage::sim
