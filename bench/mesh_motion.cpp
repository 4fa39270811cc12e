#include "bench/mesh_motion.h"

#include <cmath>

#include "io/error.h"
#include "io/mesh_reader.h"
#include "kernel/box_hierarchy.h"
#include "sim/base/points.h"

namespace selvage::bench {
namespace {

Positions positions(const io::Points& points) {
  Positions V(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) V(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = points[i][k];
  }
  return V;
}

/// In [-1, 1), from the bits of the arguments alone (the finaliser of SplitMix64 without its first shift).
double noise(int i, int j, int channel) {
  auto z = (static_cast<std::uint64_t>(i) << 40) ^ (static_cast<std::uint64_t>(j) << 16) ^
           static_cast<std::uint64_t>(channel);
  z = (z + 0x9e3779b97f4a7c15U) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-52 - 1;
}

/// Noise on a lattice of spacing 16, interpolated.
double smooth_noise(int i, int j, int channel) {
  const int a = i / 16, b = j / 16;
  const double s = (i % 16) / 16.0, t = (j % 16) / 16.0;
  return (1 - s) * ((1 - t) * noise(a, b, channel) + t * noise(a, b + 1, channel)) +
         s * ((1 - t) * noise(a + 1, b, channel) + t * noise(a + 1, b + 1, channel));
}

constexpr int kPleat = 10;  // edges from one fold to the next
constexpr double kFoldRoughness = 0.12, kTravel = 1.5;

}  // namespace

MeshMotion mesh_motion(const io::MeshData& t0, const io::MeshData& t1) {
  const auto vertex_count = static_cast<VertexId>(t0.points.size());
  if (t0.triangles.empty()) throw io::Error(io::ErrorKind::kBadInput, "the first frame has no faces");
  const Eigen::Map<const Faces> F(t0.triangles.front().data(), static_cast<Eigen::Index>(t0.triangles.size()), 3);
  InputError error = validate_faces(vertex_count, F);
  MeshMotion motion;
  if (error == InputError::kNone) {
    motion = {make_mesh(vertex_count, F), positions(t0.points), positions(t1.points)};
    error = validate(motion.mesh, motion.V_t0, motion.V_t1);
  }
  if (error != InputError::kNone) throw io::Error(io::ErrorKind::kBadInput, describe(error));
  return motion;
}

MeshMotion read_mesh_motion(const std::filesystem::path& file_t0, const std::filesystem::path& file_t1) {
  const io::MeshData t0 = io::read_mesh(file_t0), t1 = io::read_mesh(file_t1);
  const std::string both = file_t0.string() + ", " + file_t1.string() + ": ";
  if (t0.points.size() != t1.points.size()) {
    throw io::Error(io::ErrorKind::kBadInput, both + std::to_string(t0.points.size()) + " and " +
                                                  std::to_string(t1.points.size()) +
                                                  " vertices; name two frames of one mesh");
  }
  if (t0.triangles != t1.triangles) {
    throw io::Error(io::ErrorKind::kBadInput, both + "their faces differ; name two frames of one mesh");
  }
  sim::require_in_domain(t0.points, file_t0.string());
  sim::require_in_domain(t1.points, file_t1.string());
  try {
    return mesh_motion(t0, t1);
  } catch (const io::Error& error) {
    throw io::Error(error.kind(), both + error.what());
  }
}

MeshMotion crumpled_sheet(int side, double pleat_advance) {
  Positions V_t0(side * side, 3), V_t1(side * side, 3);
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const int phase = i % (2 * kPleat);
      const int height = phase < kPleat ? phase : 2 * kPleat - phase;
      const Vec3 x(pleat_advance * i + kFoldRoughness * noise(i, j, 0), j + kFoldRoughness * noise(i, j, 1),
                   height + kFoldRoughness * noise(i, j, 2));
      const Vec3 travel(smooth_noise(i, j, 3), smooth_noise(i, j, 4), smooth_noise(i, j, 5));
      V_t0.row(i * side + j) = x;
      V_t1.row(i * side + j) = x + kTravel * travel;
    }
  }
  Faces F(2 * (side - 1) * (side - 1), 3);
  Eigen::Index row = 0;
  for (int i = 0; i + 1 < side; ++i) {
    for (int j = 0; j + 1 < side; ++j) {
      const int corner = i * side + j;
      F.row(row++) << corner, corner + side, corner + 1;
      F.row(row++) << corner + side, corner + side + 1, corner + 1;
    }
  }
  return {make_mesh(side * side, F), V_t0, V_t1};
}

Candidates candidates_of(const MeshMotion& motion, double tolerance) {
  BoxHierarchy hierarchy(motion.mesh);
  hierarchy.refit(motion.V_t0, motion.V_t1, {tolerance, {}});
  return hierarchy.candidates();
}

}  // namespace selvage::bench
