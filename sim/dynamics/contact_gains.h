// What contact adds to the kinetic energy of cloth, apart for what hangs together by faces or contacts: what falls
// elsewhere hides nothing, however heavy it is.
#pragma once

#include <span>
#include <vector>

#include "sim/base/lane_vectors.h"
#include "sim/contact/repulsion_contact.h"
#include "sim/contact/surface_parts.h"

namespace selvage::sim {

class ContactGains {
 public:
  /// Of the first `cloth_count` vertices; none gained yet. O(vertices + contacts).
  ContactGains(const SurfaceParts& parts, std::span<const RepulsionContact> contacts,
               std::span<const double> inverse_mass, Eigen::Index cloth_count);

  /// None gained yet.
  void clear();
  /// What all motion gains from `before` to `after`, but for rounding. O(vertices).
  void add_motion(const LaneVectors& before, const LaneVectors& after);
  /// Work done from outside on the cloth of a vertex of it, which is no gain by contact.
  void take_work(VertexId vertex, double work_j) { twice_j_[set_of(vertex)] -= 2 * work_j; }
  /// Whether any gained more than `borne_j_kg`.
  [[nodiscard]] bool exceed(double borne_j_kg) const;
  /// Whether the cloth of a vertex of it did.
  [[nodiscard]] bool exceed_at(VertexId vertex, double borne_j_kg) const { return exceeds(set_of(vertex), borne_j_kg); }

 private:
  /// Vertices next to each other, of one set and of one parallel block.
  struct Run {
    Eigen::Index begin, end;
    std::size_t set;
    double twice_j;  ///< gained in a motion
  };
  [[nodiscard]] std::size_t set_of(VertexId vertex) const { return set_[static_cast<std::size_t>(vertex)]; }
  [[nodiscard]] bool exceeds(std::size_t set, double borne_j_kg) const {
    return twice_j_[set] > 2 * borne_j_kg * mass_kg_[set];
  }

  std::vector<std::size_t> set_;   ///< by vertex: the smallest one of its set
  std::vector<double> vertex_kg_;  ///< zero where it cannot move
  std::vector<double> mass_kg_;    ///< by set, at its smallest vertex
  std::vector<double> twice_j_;    ///< the same: twice what was gained
  std::vector<Run> runs_;
  std::vector<std::size_t> first_run_;  ///< by block
};

}  // namespace selvage::sim
