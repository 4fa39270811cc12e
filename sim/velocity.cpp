#include "sim/velocity.h"

#include "sim/parallel.h"

namespace selvage::sim {
namespace {

constexpr double kRelativeResidual = 1e-9;
constexpr std::int32_t kMaxIterations = 200;

// Row by row in order: the bits depend neither on the number of threads nor on the width of vectors.
double dot(const Positions& a, const Positions& b) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    sum += a(i, 0) * b(i, 0) + a(i, 1) * b(i, 1) + a(i, 2) * b(i, 2);
  }
  return sum;
}

class ConjugateGradients {
 public:
  ConjugateGradients(const VelocitySystem& system, const Positions& direction, double dt_s)
      : system_(system), direction_(direction), dt_s_(dt_s), diagonal_(direction_diagonal()) {}

  // result = (1 + dt drag) m v + B v on free rows, 0 on the others.
  void apply(const Positions& v, Positions& result) {
    damping_impulses(system_, direction_, v, result, scratch_);
    parallel_each(result.rows(), [&](Eigen::Index i) {
      const double w = inverse_mass(i);
      if (w > 0) {
        result.row(i) += ((1 + dt_s_ * system_.drag_1_s) / w) * v.row(i);
      } else {
        result.row(i).setZero();
      }
    });
  }

  std::int32_t solve(const Positions& rhs, Positions& v) {
    Positions residual(v.rows(), 3), step, product, scaled(v.rows(), 3);
    apply(v, product);
    for (Eigen::Index i = 0; i < v.rows(); ++i) {
      if (inverse_mass(i) > 0) {
        residual.row(i) = rhs.row(i) / inverse_mass(i) - product.row(i);
        scaled.row(i) = rhs.row(i) / inverse_mass(i);
      } else {
        residual.row(i).setZero();
        scaled.row(i).setZero();
      }
    }
    const double scale = dot(scaled, preconditioned(scaled));
    scaled = preconditioned(residual);
    step = scaled;
    double energy = dot(residual, scaled);
    std::int32_t iteration = 0;
    // Written so that NaN ends the loop: the caller finds it in the velocity.
    while (iteration < kMaxIterations && energy > kRelativeResidual * kRelativeResidual * scale) {
      apply(step, product);
      const double along = energy / dot(step, product);
      v += along * step;
      residual -= along * product;
      scaled = preconditioned(residual);
      const double next = dot(residual, scaled);
      step = scaled + (next / energy) * step;
      energy = next;
      ++iteration;
    }
    damping_impulses(system_, direction_, v, product, scratch_);
    for (Eigen::Index i = 0; i < v.rows(); ++i) {
      const double w = inverse_mass(i);
      if (w > 0) v.row(i) = (rhs.row(i) - w * product.row(i)) / (1 + dt_s_ * system_.drag_1_s);
    }
    return iteration;
  }

 private:
  [[nodiscard]] double inverse_mass(Eigen::Index i) const { return system_.inverse_mass[static_cast<std::size_t>(i)]; }
  [[nodiscard]] Positions direction_diagonal() const {
    Positions diagonal(system_.springs.vertex_count(), 3);
    parallel_each(diagonal.rows(), [&](Eigen::Index i) {
      const double w = inverse_mass(i);
      Eigen::RowVector3d sum = Eigen::RowVector3d::Constant(w > 0 ? (1 + dt_s_ * system_.drag_1_s) / w : 1);
      system_.springs.for_each_at(static_cast<VertexId>(i), [&](std::uint32_t s, double) {
        sum += system_.spring_coefficient[s] * direction_.row(s).cwiseAbs2();
      });
      if (system_.stabilizers != nullptr) {
        sum.array() += system_.stabilizers->diagonal(static_cast<VertexId>(i), system_.stabilizer_stiffness_share,
                                                     system_.stabilizer_damping_share);
      }
      diagonal.row(i) = sum;
    });
    return diagonal;
  }
  [[nodiscard]] Positions preconditioned(const Positions& residual) const {
    return (residual.array() / diagonal_.array()).matrix();
  }

  const VelocitySystem& system_;
  const Positions& direction_;
  double dt_s_;
  Positions diagonal_;
  Positions scratch_;
};

}  // namespace

void damping_impulses(const VelocitySystem& system, const Positions& direction, const Positions& v, Positions& result,
                      Positions& scratch) {
  system.springs.apply(direction, system.spring_coefficient, v, result, scratch);
  if (system.stabilizers == nullptr) return;
  system.stabilizers->add_forces(v, -system.stabilizer_stiffness_share, -system.stabilizer_damping_share, result);
}

std::int32_t solve_velocity(const VelocitySystem& system, const Positions& direction, const Positions& rhs, double dt_s,
                            Positions& v) {
  return ConjugateGradients(system, direction, dt_s).solve(rhs, v);
}

}  // namespace selvage::sim
