// Where the surface of a body goes straight on through one of its features: along a ridge that has vertices on it, a
// generator of a capsule, or in a plane. Such a feature is no corner, and cloth must not feel it as one. Nearest to its
// vertices and edges are points of cloth to which they are not nearest, as the surface beside them is nearer still, and
// the direction between the two has a part along the surface. Repelled along it, cloth without friction that slid down
// a ridge with rows of vertices kept 1.58 of 2.66 m/s, and a rod that moved along its own axis took cloth along
// (docs/measurements/stability.md).
//
// It is straight as far as the line, or the faces around the feature, go. Cloth beyond that is nearer to another
// feature and not repelled by this one: behind the plane of a box's side lies what slides on its top.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/mesh.h"
#include "sim/base/vertex_faces.h"

namespace selvage::sim {

/// Told by vertices, as these may move.
struct StraightSurface {
  enum class Kind : std::uint8_t { kCorner, kLine, kPlane };
  Kind kind = Kind::kCorner;
  std::array<VertexId, 4> ends{};  ///< kLine: it goes from 0 to 1. kPlane: so does one in it, and one from 2 to 3.
  /// How far it surely goes on from a vertex: against direction(), and along it; of a plane, all ways, both the same.
  /// From within an edge a share of that goes on (StraightFeature).
  std::array<double, 2> extents_m{};

  /// Unit: along the line, either way, or the normal of the plane, on either side. Zero for a corner.
  [[nodiscard]] Vec3 direction(const Positions& V) const;
};

/// At a vertex of a body that is in a pair, or within an edge of one and at its two ends.
struct StraightFeature {
  enum Part : std::uint8_t { kWithin, kFirstEnd, kSecondEnd };
  std::array<StraightSurface, 3> parts;  ///< by Part; a vertex has the first
  std::uint8_t first = 0;                ///< of the edge: its place among the vertices of the pair, 0 or 2

  [[nodiscard]] bool is_anywhere() const;
  /// The part that points with these weights are on, as in Interaction.
  [[nodiscard]] Part part(PairKind kind, const std::array<double, 4>& weights) const;
  /// The share of its extents that goes on from there: within an edge the weight of the nearer end.
  [[nodiscard]] double extent_share(PairKind kind, const std::array<double, 4>& weights) const;
};

/// The angle by which what is straight may bend. A vertex of a file in float32, a metre from the origin and a
/// centimetre from the next one, is off by 6e-6. Curved bodies are none of this: to go straight on for a step at 3 m/s
/// along a ball of 0.3 m would be off by 3 mm.
inline constexpr double kStraight = 1e-3;

/// Less is left of a direction by rounding alone.
inline constexpr double kLeastAcross = 0x1p-20;

/// The direction from a point of such a surface to another one.
struct Across {
  Vec3 unit;               ///< without the part along the line or in the plane; as it was where nothing is left
  bool is_beyond = false;  ///< the other point lies farther along than it is straight, or in it: it is not over it
};

/// `direction` is the surface's, `unit` that of the other point, which is `distance` away. A corner changes nothing.
[[nodiscard]] Across across(const StraightSurface& surface, double extent_share, const Vec3& direction,
                            const Vec3& unit, double distance);

class StraightSurfaces {
 public:
  /// Both must outlive it.
  StraightSurfaces(const Mesh& mesh, const VertexFaces& faces)
      : mesh_(mesh), faces_(faces), at_(static_cast<std::size_t>(mesh.vertex_count)), is_known_(at_.size()) {}

  /// From now on where the vertices are at V, #V by 3. What is known of these very positions is kept.
  void start(const Positions& V);

  /// Of the body in a pair as in PairProximity: its vertex in vf, or its edge in ee. A vertex of cloth against a face,
  /// and two edges of cloth, have corners alone. `is_cloth` is #V. What is found of a vertex is kept until start(); in
  /// O(f log f) of its f faces, O(f^2) while they are 64 or fewer, and O(faces along a line of 32 edges); of an edge in
  /// O(faces at one end). Any number of threads may ask.
  [[nodiscard]] StraightFeature of(PairKind kind, const std::array<VertexId, 4>& vertices,
                                   const std::vector<std::uint8_t>& is_cloth) const;

 private:
  /// A face at a vertex: its other corners, and the unit vectors to them.
  struct Sector {
    std::array<VertexId, 2> ends;
    std::array<Vec3, 2> ways;
    [[nodiscard]] double sine() const;  ///< of its angle
  };
  using Fan = std::vector<Sector>;

  [[nodiscard]] StraightSurface at(VertexId vertex) const;
  [[nodiscard]] StraightSurface find_at(VertexId vertex) const;
  [[nodiscard]] StraightSurface within(VertexId a, VertexId b) const;
  [[nodiscard]] static bool surrounds(const Fan& faces, const Vec3& normal);
  [[nodiscard]] StraightSurface plane_around(VertexId vertex, const Fan& fan) const;
  [[nodiscard]] StraightSurface line_through(VertexId vertex, const Fan& fan) const;
  [[nodiscard]] double line_extent(VertexId from, VertexId to) const;

  enum Known : std::uint8_t { kNo, kBeingFound, kYes };

  const Mesh& mesh_;
  const VertexFaces& faces_;
  Positions V_;
  mutable std::vector<StraightSurface> at_;     ///< #V, written by the one thread that finds it
  mutable std::vector<std::uint8_t> is_known_;  ///< #V, Known
};

}  // namespace selvage::sim
