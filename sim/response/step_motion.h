// The step while it is being made: where every vertex starts, how far it goes, and the stored position that gives.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/types.h"
#include "sim/base/lattice.h"

namespace selvage::sim {

class StepMotion {
 public:
  void start(const PositionsRef& V_t0, const PositionsRef& V_t1, Precision precision);

  [[nodiscard]] const Positions& V_t0() const { return V_t0_; }
  /// #V by 3, m: dt times the average velocity, before rounding to x.
  [[nodiscard]] const Positions& displacement() const { return displacement_; }
  /// #V by 3: what will be stored, and what is certified. A vertex that nothing touched has its candidate's bits.
  [[nodiscard]] const Positions& x() const { return x_; }
  /// Whether the stored position differs from the start.
  [[nodiscard]] bool moves(VertexId vertex) const { return x_.row(vertex) != V_t0_.row(vertex); }

  /// x = V_t0 + displacement on the lattice. At the edge of the domain the displacement is cut to what is left.
  void move(VertexId vertex, const Vec3& displacement);
  /// x = V_t0; a zero may keep the sign that its candidate had.
  void freeze(VertexId vertex);

  /// #V: 1 where the stored position changed since the last take.
  std::vector<std::uint8_t> take_changed();
  [[nodiscard]] bool anything_changed() const { return anything_changed_; }

 private:
  void store(VertexId vertex, const Vec3& x);

  Positions V_t0_, displacement_, x_;
  std::vector<std::uint8_t> changed_;
  bool anything_changed_ = false;
  Precision precision_ = Precision::kFloat64;
};

}  // namespace selvage::sim
