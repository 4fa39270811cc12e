#include "sim/dynamics/velocity.h"

#include <algorithm>

#include "sim/base/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/dynamics/velocity.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/base/lane_sum-inl.h"
#include "sim/base/lane_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

HWY_INLINE Value InverseMass(const VelocitySystem& system, Eigen::Index row) {
  return hn::LoadU(Real(), system.inverse_mass.data() + row);
}

/// v where impulses are what they are.
HWY_INLINE void WriteVelocity(Value w, Value drag, const Vector& rhs, const Vector& impulse, Eigen::Index row,
                              LaneVectors& v) {
  const Vector kicked = lanes::Minus<Real>(rhs, lanes::Times<Real>(w, impulse));
  const Vector after = {hn::Div(kicked.x, drag), hn::Div(kicked.y, drag), hn::Div(kicked.z, drag)};
  WriteRows(lanes::Choose<Real>(hn::Gt(w, hn::Zero(Real())), after, ReadRows(Axes(v), row)), v, row);
}

void FindVelocity(const VelocitySystem& system, double drag, const LaneVectors& rhs, const LaneVectors& impulses,
                  Eigen::Index begin, Eigen::Index end, LaneVectors& v) {
  const Axes kicked(rhs), impulse(impulses);
  const Value drag_in_step = hn::Set(Real(), drag);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    WriteVelocity(InverseMass(system, row), drag_in_step, ReadRows(kicked, row), ReadRows(impulse, row), row, v);
  }
}

/// From the product of the guess: the residual, the first step, and the impulses of the guess.
SolutionNorms Begin(const VelocitySystem& system, double drag, const LaneVectors& rhs, Eigen::Index begin,
                    Eigen::Index end, const SolutionVectors& vectors) {
  const Real d;
  const Axes kicked(rhs), products(vectors.product), impulses(vectors.impulses), diagonal(system.springs.diagonal());
  const Value zero = hn::Zero(d), one = hn::Set(d, 1.0), drag_in_step = hn::Set(d, drag);
  LaneSum residuals, of_impulses, momenta;
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Value w = InverseMass(system, row);
    const auto moves = hn::Gt(w, zero);
    const Value mass = hn::Div(drag_in_step, w);
    const Vector own = ReadRows(diagonal, row);
    const auto inverse = [&](Value element)
                             HWY_ATTR { return hn::IfThenElseZero(moves, hn::Div(one, hn::Add(element, mass))); };
    const Vector inverse_diagonal = {inverse(own.x), inverse(own.y), inverse(own.z)};
    const Vector product = ReadRows(products, row), residual = lanes::Minus<Real>(ReadRows(impulses, row), product);
    const Vector step = lanes::Product<Real>(residual, inverse_diagonal), before = ReadRows(kicked, row);
    WriteRows(inverse_diagonal, vectors.inverse_diagonal, row);
    WriteRows(residual, vectors.residual, row);
    WriteRows(product, vectors.impulses, row);
    WriteRows(step, vectors.step, row);
    residuals.Add(row, lanes::Dot<Real>(residual, step));
    of_impulses.Add(row, lanes::Dot<Real>(product, lanes::Product<Real>(product, inverse_diagonal)));
    const Value momentum =
        hn::Div(lanes::Dot<Real>(before, lanes::Product<Real>(before, inverse_diagonal)), hn::Mul(w, w));
    momenta.Add(row, hn::IfThenElseZero(moves, momentum));
  }
  return {residuals.total(), of_impulses.total(), momenta.total()};
}

/// From the product of the step: its product with the matrix.
double Curvature(const VelocitySystem& system, double drag, Eigen::Index begin, Eigen::Index end,
                 const SolutionVectors& vectors) {
  const Real d;
  const Axes products(vectors.product), steps(vectors.step);
  const Value zero = hn::Zero(d), drag_in_step = hn::Set(d, drag);
  LaneSum sum;
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Value w = InverseMass(system, row);
    const Vector step = ReadRows(steps, row);
    const Value of_mass = hn::Mul(hn::Div(drag_in_step, w), lanes::Dot<Real>(step, step));
    const Value of_springs = lanes::Dot<Real>(step, ReadRows(products, row));
    sum.Add(row, hn::IfThenElseZero(hn::Gt(w, zero), hn::Add(of_springs, of_mass)));
  }
  return sum.total();
}

/// Goes `along` times the step, with v. Returns the squared norm of the residual that is left.
double GoAlong(const VelocitySystem& system, double drag, const LaneVectors& rhs, double along, Eigen::Index begin,
               Eigen::Index end, const SolutionVectors& vectors, LaneVectors& v) {
  const Real d;
  const Axes kicked(rhs), products(vectors.product), steps(vectors.step), impulses(vectors.impulses);
  const Axes residuals(vectors.residual), inverse_diagonals(vectors.inverse_diagonal);
  const Value zero = hn::Zero(d), drag_in_step = hn::Set(d, drag), far = hn::Set(d, along);
  LaneSum sum;
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Value w = InverseMass(system, row);
    const auto moves = hn::Gt(w, zero);
    const Vector product = ReadRows(products, row);
    const Vector impulse = lanes::Plus<Real>(ReadRows(impulses, row), lanes::Times<Real>(far, product));
    WriteRows(impulse, vectors.impulses, row);
    WriteVelocity(w, drag_in_step, ReadRows(kicked, row), impulse, row, v);
    const Vector of_step = lanes::Plus<Real>(
        product, lanes::Times<Real>(hn::IfThenElseZero(moves, hn::Div(drag_in_step, w)), ReadRows(steps, row)));
    const Vector residual = lanes::Minus<Real>(ReadRows(residuals, row), lanes::Times<Real>(far, of_step));
    WriteRows(residual, vectors.residual, row);
    sum.Add(row, lanes::Dot<Real>(residual, lanes::Product<Real>(residual, ReadRows(inverse_diagonals, row))));
  }
  return sum.total();
}

/// The next step, conjugate to the last.
void Turn(double turn, Eigen::Index begin, Eigen::Index end, const SolutionVectors& vectors) {
  const Axes residuals(vectors.residual), inverse_diagonals(vectors.inverse_diagonal), steps(vectors.step);
  const Value share = hn::Set(Real(), turn);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Vector preconditioned = lanes::Product<Real>(ReadRows(residuals, row), ReadRows(inverse_diagonals, row));
    const Vector step = lanes::Plus<Real>(preconditioned, lanes::Times<Real>(share, ReadRows(steps, row)));
    WriteRows(step, vectors.step, row);
  }
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::sim {
namespace {

constexpr std::int32_t kMaxIterations = 200;

}  // namespace

HWY_EXPORT(FindVelocity);
HWY_EXPORT(Begin);
HWY_EXPORT(Curvature);
HWY_EXPORT(GoAlong);
HWY_EXPORT(Turn);

SolutionNorms& SolutionNorms::operator+=(const SolutionNorms& other) {
  residual += other.residual;
  impulses += other.impulses;
  momentum += other.momentum;
  return *this;
}

std::int32_t VelocitySolver::solve(const VelocitySystem& system, const LaneVectors& rhs, double dt_s,
                                   LaneVectors& impulses, LaneVectors& v, double residual) {
  const Eigen::Index rows = rhs.rows();
  for (LaneVectors* X : {&residual_, &step_, &product_, &inverse_diagonal_, &impulses}) X->resize(rows);
  const SolutionVectors vectors{residual_, step_, product_, inverse_diagonal_, impulses};
  const double drag = 1 + dt_s * system.drag_1_s;
  const auto find_velocity = [&] {
    parallel_blocks(rows, [&](Eigen::Index begin, Eigen::Index end) {
      HWY_DYNAMIC_DISPATCH(FindVelocity)(system, drag, rhs, impulses, begin, end, v);
    });
  };
  find_velocity();
  system.springs.begin_product(system.x, v);
  const SolutionNorms norms = parallel_sum(rows, partial_norms_, [&](Eigen::Index begin, Eigen::Index end) {
    system.springs.multiply_rows(system.x, v, begin, end, product_);
    return HWY_DYNAMIC_DISPATCH(Begin)(system, drag, rhs, begin, end, vectors);
  });
  double energy = norms.residual;
  const double limit = residual * residual * std::min(norms.impulses, norms.momentum);
  std::int32_t iteration = 0;
  // Written so that NaN ends the loop: the caller finds it in the velocity.
  for (; iteration < kMaxIterations && energy > limit; ++iteration) {
    system.springs.begin_correction(system.x, step_);
    const double curvature = parallel_sum(rows, partial_, [&](Eigen::Index begin, Eigen::Index end) {
      system.springs.multiply_rows(system.x, step_, begin, end, product_);
      return HWY_DYNAMIC_DISPATCH(Curvature)(system, drag, begin, end, vectors);
    });
    const double next = parallel_sum(rows, partial_, [&](Eigen::Index begin, Eigen::Index end) {
      return HWY_DYNAMIC_DISPATCH(GoAlong)(system, drag, rhs, energy / curvature, begin, end, vectors, v);
    });
    if (next > limit) {
      parallel_blocks(rows, [&](Eigen::Index begin, Eigen::Index end) {
        HWY_DYNAMIC_DISPATCH(Turn)(next / energy, begin, end, vectors);
      });
    }
    energy = next;
  }
  if (iteration == 0) find_velocity();
  return iteration;
}

}  // namespace selvage::sim
#endif
