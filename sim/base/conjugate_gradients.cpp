#include "sim/base/conjugate_gradients.h"

#include <algorithm>
#include <cmath>

#include "kernel/arithmetic/power_of_two.h"
#include "sim/base/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sim/base/conjugate_gradients.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sim/base/lane_sum-inl.h"
#include "sim/base/lane_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace selvage::sim::HWY_NAMESPACE {

/// The blocks from `i` on times what stands in the lanes.
HWY_INLINE Vector BlockProduct(const LaneBlocks& blocks, std::size_t i, const Vector& x) {
  const Real d;
  const double* const at = blocks.at(i);
  const auto element = [&](int k) HWY_ATTR { return hn::LoadU(d, at + k * kLanes); };
  const Value xy = element(1), xz = element(2), yz = element(4);
  return {lanes::Dot<Real>({element(0), xy, xz}, x), lanes::Dot<Real>({xy, element(3), yz}, x),
          lanes::Dot<Real>({xz, yz, element(5)}, x)};
}

void Multiply(const BlockMatrix& A, const LaneVectors& vectors, Eigen::Index begin, Eigen::Index end,
              LaneVectors& product) {
  const Axes x(vectors);
  const LaneBlocks& off_diagonals = A.off_diagonals();
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    Vector sum = BlockProduct(A.diagonals(), static_cast<std::size_t>(row), ReadRows(x, row));
    ForEachSlot(A.table(), row, [&](std::size_t entry, auto read) HWY_ATTR SELVAGE_INLINE_LAMBDA {
      sum = lanes::Plus<Real>(sum, BlockProduct(off_diagonals, entry, read(x)));
    });
    WriteRows(sum, product, row);
  }
}

double DotRows(const LaneVectors& a, const LaneVectors& b, Eigen::Index begin, Eigen::Index end) {
  const Axes first(a), second(b);
  LaneSum sum;
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    sum.Add(row, lanes::Dot<Real>(ReadRows(first, row), ReadRows(second, row)));
  }
  return sum.total();
}

/// Goes `along` times the step. Returns the squared norm of the residual that is left.
double Descend(const LaneBlocks& preconditioner, double along, const LaneVectors& steps, const LaneVectors& products,
               Eigen::Index begin, Eigen::Index end, LaneVectors& x, LaneVectors& residuals) {
  const Axes step(steps), product(products), known(x), left(residuals);
  const Value far = hn::Set(Real(), along);
  LaneSum sum;
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    WriteRows(lanes::Plus<Real>(ReadRows(known, row), lanes::Times<Real>(far, ReadRows(step, row))), x, row);
    const Vector residual = lanes::Minus<Real>(ReadRows(left, row), lanes::Times<Real>(far, ReadRows(product, row)));
    WriteRows(residual, residuals, row);
    sum.Add(row, lanes::Dot<Real>(residual, BlockProduct(preconditioner, static_cast<std::size_t>(row), residual)));
  }
  return sum.total();
}

/// The next step, conjugate to the last.
void TurnRows(const LaneBlocks& preconditioner, double turn, const LaneVectors& residuals, Eigen::Index begin,
              Eigen::Index end, LaneVectors& steps) {
  const Axes residual(residuals), step(steps);
  const Value share = hn::Set(Real(), turn);
  for (Eigen::Index row = begin; row < end; row += VectorRows()) {
    const Vector preconditioned = BlockProduct(preconditioner, static_cast<std::size_t>(row), ReadRows(residual, row));
    WriteRows(lanes::Plus<Real>(preconditioned, lanes::Times<Real>(share, ReadRows(step, row))), steps, row);
  }
}

}  // namespace selvage::sim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace selvage::sim {
namespace {

// By cofactors, of the block over a power of two: their products of three have other exponents than the inverse. False
// for a block that is not positive definite, by Sylvester's criterion.
bool invert(SymmetricBlock m, SymmetricBlock& inverse) {
  const double largest = std::max({m[0], m[3], m[5]});
  const int exponent = largest > 0 ? detail::exponent_of(largest) : 0;
  for (double& element : m) element = detail::times_power(element, -exponent);
  const double xx = m[3] * m[5] - m[4] * m[4], xy = m[2] * m[4] - m[1] * m[5], xz = m[1] * m[4] - m[2] * m[3];
  const double determinant = m[0] * xx + m[1] * xy + m[2] * xz, scale = 1 / determinant;
  inverse = {scale * xx,
             scale * xy,
             scale * xz,
             scale * (m[0] * m[5] - m[2] * m[2]),
             scale * (m[1] * m[2] - m[0] * m[4]),
             scale * (m[0] * m[3] - m[1] * m[1])};
  for (double& element : inverse) element = detail::times_power(element, -exponent);
  return m[0] > 0 && m[0] * m[3] - m[1] * m[1] > 0 && determinant > 0;
}

}  // namespace

HWY_EXPORT(Multiply);
HWY_EXPORT(DotRows);
HWY_EXPORT(Descend);
HWY_EXPORT(TurnRows);

bool ConjugateGradients::invert_diagonal(const BlockMatrix& A, const Coupling* coupling,
                                         std::span<const std::uint8_t> is_free) {
  preconditioner_.reset(is_free.size());
  is_definite_.assign(is_free.size(), 1);
  parallel_each(A.rows(), [&](Eigen::Index i) {
    const auto row = static_cast<std::size_t>(i);
    if (is_free[row] == 0) return;
    SymmetricBlock diagonal = A.diagonal(i), inverse;
    if (coupling != nullptr) coupling->add_diagonal(i, diagonal);
    is_definite_[row] = invert(diagonal, inverse) ? 1 : 0;
    preconditioner_.set(row, inverse);
  });
  return std::ranges::find(is_definite_, 0) == is_definite_.end();
}

ConjugateGradientsResult ConjugateGradients::solve(const BlockMatrix& A, const Coupling* coupling,
                                                   std::span<const std::uint8_t> is_free, const Positions& rhs,
                                                   double relative_residual, std::int32_t max_iterations,
                                                   Positions& x) {
  const Eigen::Index rows = A.rows();
  ConjugateGradientsResult result;
  result.definite = invert_diagonal(A, coupling, is_free);
  x = Positions::Zero(rows, 3);
  if (!result.definite) return result;
  residual_.copy(rhs);
  for (LaneVectors* vectors : {&x_, &step_, &product_}) {
    vectors->resize(rows);
    vectors->set_zero();
  }
  const auto descend = [&](double along) {
    return parallel_sum(rows, partial_, [&](Eigen::Index begin, Eigen::Index end) {
      return HWY_DYNAMIC_DISPATCH(Descend)(preconditioner_, along, step_, product_, begin, end, x_, residual_);
    });
  };
  const auto turn = [&](double share) {
    parallel_blocks(rows, [&](Eigen::Index begin, Eigen::Index end) {
      HWY_DYNAMIC_DISPATCH(TurnRows)(preconditioner_, share, residual_, begin, end, step_);
    });
  };
  double energy = descend(0);
  turn(0);
  const double enough = relative_residual * relative_residual * energy;
  // Written so that NaN ends the loop.
  while (result.iterations < max_iterations && energy > enough) {
    parallel_blocks(rows, [&](Eigen::Index begin, Eigen::Index end) {
      HWY_DYNAMIC_DISPATCH(Multiply)(A, step_, begin, end, product_);
    });
    if (coupling != nullptr) coupling->add_product(step_, product_);
    // Rows that are not free have no step, so what the product has there does not count.
    const double curvature = parallel_sum(rows, partial_, [&](Eigen::Index begin, Eigen::Index end) {
      return HWY_DYNAMIC_DISPATCH(DotRows)(step_, product_, begin, end);
    });
    if (curvature <= 0) {
      result.definite = false;
      return result;
    }
    const double next = descend(energy / curvature);
    turn(next / energy);
    energy = next;
    ++result.iterations;
  }
  result.converged = std::isfinite(energy) && energy <= enough;
  x_.copy_to(x);
  return result;
}

}  // namespace selvage::sim
#endif
