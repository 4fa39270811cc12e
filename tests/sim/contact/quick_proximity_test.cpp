// Nearest points in plain doubles: as near as the kernel's, and the same bits for one pair and for many.
#include "sim/contact/quick_proximity.h"

#include "kernel/collisions.h"
#include "kernel/proximity.h"
#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/vector_units.h"

namespace selvage::sim::testbed {
namespace {

/// Lattice points tie, coincide, and make features of no size.
double lattice_or_not() { return *rc::gen::inRange(0, 2) != 0 ? *rc::gen::inRange(-3, 4) : number_between(-3, 3); }

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }
bool same(const QuickProximity& a, const QuickProximity& b) {
  bool result = same(a.distance, b.distance);
  for (std::size_t k = 0; k < 4; ++k) result &= same(a.weights[k], b.weights[k]);
  for (Eigen::Index axis = 0; axis < 3; ++axis) result &= same(a.direction[axis], b.direction[axis]);
  return result;
}

template <typename Candidate>
std::vector<QuickProximity> one_by_one(const Mesh& mesh, PairKind kind, const std::vector<Candidate>& pairs,
                                       const Positions& V) {
  std::vector<QuickProximity> result;
  for (const auto& [first, second] : pairs) {
    PairVectors x;
    const auto vertices = pair_vertices(mesh, kind, first, second);
    for (std::size_t k = 0; k < 4; ++k) x[k] = V.row(vertices[k]);
    result.push_back(quick_proximity(kind, x));
  }
  return result;
}

template <typename Candidate>
void expect_same_bits(const Mesh& mesh, PairKind kind, const std::vector<Candidate>& pairs, const Positions& V) {
  const std::vector<QuickProximity> expected = one_by_one(mesh, kind, pairs, V);
  std::vector<std::string> wrong;
  selvage::testing::on_every_vector_unit([&](const char* unit) {
    const auto ones = one_by_one(mesh, kind, pairs, V);
    QuickProximities many;
    quick_proximities(detail::LanePairs(mesh, pairs), V, many);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (!same(ones[i], expected[i]) || !same(many[i], expected[i])) wrong.emplace_back(unit);
    }
  });
  RC_ASSERT(wrong == std::vector<std::string>{});
}

}  // namespace

TEST(QuickProximity, PropIsAsNearAsTheKernelsAnswer) {
  selvage::testing::check_property(200, 31, [] {
    PairVectors x;
    for (Vec3& point : x) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        point[axis] = lattice_or_not();
      }
    }
    for (const PairKind kind : {PairKind::kVf, PairKind::kEe}) {
      const bool is_vf = kind == PairKind::kVf;
      const Vec3 u = x[is_vf ? 2 : 1] - x[is_vf ? 1 : 0], v = x[3] - x[is_vf ? 1 : 2];
      if (u.cross(v).norm() < 1e-6 || (is_vf && u == v)) continue;  // no area, or parallel
      const Proximity exact = is_vf ? vf_proximity(x) : ee_proximity(x);
      const QuickProximity quick = quick_proximity(kind, x);
      RC_ASSERT(std::abs(quick.distance - exact.distance) <= 1e-9);
      Vec3 sum = Vec3::Zero();
      for (std::size_t k = 0; k < 4; ++k) sum += quick.weights[k] * x[k];
      if (exact.distance > 1e-9) RC_ASSERT((sum - quick.distance * quick.direction).norm() <= 1e-12);
      const double scale = std::ldexp(1.0, *rc::gen::element(-900, -300, 300, 900));
      for (Vec3& point : x) point *= scale;
      const QuickProximity scaled = quick_proximity(kind, x);
      for (Vec3& point : x) point /= scale;
      RC_ASSERT(scaled.distance == scale * quick.distance);
      RC_ASSERT(scaled.weights == quick.weights);
    }
  });
}

// Any pairs of a soup of points, so that all branches stand side by side in the lanes; the last vector is not full.
TEST(QuickProximity, PropOnePairAndManyHaveTheSameBitsOnEveryVectorUnit) {
  selvage::testing::check_property(100, 34, [] {
    constexpr VertexId kPoints = 12;
    Positions V(kPoints, 3);
    for (Eigen::Index i = 0; i < V.size(); ++i) V.data()[i] = lattice_or_not();
    V *= std::ldexp(1.0, *rc::gen::element(-900, 0, 900));
    Faces faces(20, 3);
    const auto point = [] { return *rc::gen::inRange(VertexId{0}, kPoints); };
    for (Eigen::Index i = 0; i < faces.rows(); ++i) {
      const VertexId first = point();
      faces.row(i) << first, (first + 1 + point() % 5) % kPoints, (first + 6 + point() % 6) % kPoints;
    }
    const Mesh mesh = make_mesh(kPoints, faces);
    const auto count = *rc::gen::inRange(1, 40);
    std::vector<VfCandidate> vf;
    std::vector<EeCandidate> ee;
    for (int i = 0; i < count; ++i) {
      vf.push_back({point(), *rc::gen::inRange(0, static_cast<int>(mesh.faces.size()))});
      const auto edge = [&] { return *rc::gen::inRange(0, static_cast<int>(mesh.edges.size())); };
      ee.push_back({edge(), edge()});
    }
    expect_same_bits(mesh, PairKind::kVf, vf, V);
    expect_same_bits(mesh, PairKind::kEe, ee, V);
  });
}

}  // namespace selvage::sim::testbed
