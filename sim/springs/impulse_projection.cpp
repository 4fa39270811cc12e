#include "sim/springs/impulse_projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace selvage::sim {
namespace {

/// Of what is left to improve, over that without any impulse. docs/numerics.md (*Limits on strain*) says what it
/// leaves.
constexpr double kTolerance = 0.02;

/// Added to the scaled system's diagonal: where bounds cannot all be kept, as between two pins that part, impulses
/// would grow without end. A cloth of 150 springs that hangs at its limit in steps of 0.4 ms gives way by 150 g 0.4 ms
/// times this, 0.06 mm/s a spring.
constexpr double kCompliance = 1e-4;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// y += factor x
void add(double factor, const std::vector<double>& x, std::vector<double>& y) {
  for (std::size_t i = 0; i < x.size(); ++i) y[i] += factor * x[i];
}

}  // namespace

ImpulseProjection::ImpulseProjection(std::int32_t vertex_count)
    : row_vertex_(static_cast<std::size_t>(vertex_count), -1) {}

std::size_t ImpulseProjection::row_vertex(VertexId vertex) {
  std::int32_t& id = row_vertex_[static_cast<std::size_t>(vertex)];
  if (id < 0) {
    id = static_cast<std::int32_t>(vertices_.size());
    vertices_.push_back(vertex);
  }
  return static_cast<std::size_t>(id);
}

// The largest eigenvalue is at most the largest number of pairs at a vertex that can move: q^T A q is the sum over the
// vertices of w |sum of q_i n_i|^2 <= w n sum of q_i^2, and each q_i^2 (w_a + w_b) is in it once.
void ImpulseProjection::set_rows(const std::vector<BoundedPair>& pairs) {
  rows_.clear();
  vertices_.clear();
  for (const BoundedPair& pair : pairs) {
    const double scale = 1 / std::sqrt(pair.inverse_mass_a + pair.inverse_mass_b);
    const std::size_t a = row_vertex(pair.a), b = row_vertex(pair.b);
    rows_.push_back({a, b, pair.inverse_mass_a, pair.inverse_mass_b, scale, scale * pair.direction});
  }
  for (const VertexId vertex : vertices_) row_vertex_[static_cast<std::size_t>(vertex)] = -1;
  impulse_at_.resize(vertices_.size());
  std::vector<std::int32_t> count(vertices_.size());
  std::int32_t most = 1;
  for (const Row& row : rows_) {
    if (row.inverse_mass_a > 0) most = std::max(most, ++count[row.a]);
    if (row.inverse_mass_b > 0) most = std::max(most, ++count[row.b]);
  }
  step_ = 1 / (most + kCompliance);
}

void ImpulseProjection::multiply(const std::vector<double>& q, std::vector<double>& product) {
  std::ranges::fill(impulse_at_, Vec3::Zero());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    impulse_at_[row.a] += q[i] * row.direction;
    impulse_at_[row.b] -= q[i] * row.direction;
  }
  product.resize(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    product[i] = row.direction.dot(row.inverse_mass_a * impulse_at_[row.a] - row.inverse_mass_b * impulse_at_[row.b]) +
                 kCompliance * q[i];
  }
}

ImpulseProjection::Left ImpulseProjection::left() const {
  Left left;
  for (std::size_t i = 0; i < q_.size(); ++i) {
    const double g = gradient_[i];
    if (q_[i] > 0) {
      left.acting += std::min(q_[i] / step_, g) * g;
    } else if (g < 0) {
      left.missing += g * g;
    }
  }
  return left;
}

void ImpulseProjection::take_guess() {
  multiply(q_, product_);
  const double curvature = dot(q_, product_);
  const double share = curvature > 0 ? std::clamp(-dot(q_, gradient_) / curvature, 0.0, 1.0) : 0;
  for (double& q : q_) q *= share;
  add(share, product_, gradient_);
}

/// Down the gradient of those that have none.
void ImpulseProjection::add_missing() {
  for (std::size_t i = 0; i < q_.size(); ++i) direction_[i] = q_[i] > 0 ? 0 : std::max(-gradient_[i], 0.0);
  multiply(direction_, product_);
  const double length = -dot(gradient_, direction_) / dot(direction_, product_);
  add(length, direction_, q_);
  add(length, product_, gradient_);
  is_new_face_ = true;
}

/// A step of conjugate gradients; where one would pull, as far as that lets it, then down the gradient.
void ImpulseProjection::improve_acting() {
  if (is_new_face_) {
    for (std::size_t i = 0; i < q_.size(); ++i) direction_[i] = q_[i] > 0 ? -gradient_[i] : 0;
    is_new_face_ = false;
  }
  multiply(direction_, product_);
  const double curvature = dot(direction_, product_);
  const double length = -dot(gradient_, direction_) / curvature;
  double feasible = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < q_.size(); ++i) {
    if (direction_[i] < 0) feasible = std::min(feasible, -q_[i] / direction_[i]);
  }
  const double taken = std::min(length, feasible);
  for (std::size_t i = 0; i < q_.size(); ++i) q_[i] = std::max(0.0, q_[i] + taken * direction_[i]);
  add(taken, product_, gradient_);
  if (length > feasible) return project_gradient();
  double along = 0;
  for (std::size_t i = 0; i < q_.size(); ++i) along += q_[i] > 0 ? gradient_[i] * product_[i] : 0;
  for (std::size_t i = 0; i < q_.size(); ++i) {
    direction_[i] = (q_[i] > 0 ? -gradient_[i] : 0) + along / curvature * direction_[i];
  }
}

/// As far as no impulse pulls.
void ImpulseProjection::project_gradient() {
  for (std::size_t i = 0; i < q_.size(); ++i) {
    const double next = q_[i] > 0 ? std::max(0.0, q_[i] - step_ * gradient_[i]) : 0;
    direction_[i] = next - q_[i];
    q_[i] = next;
  }
  multiply(direction_, product_);
  add(1, product_, gradient_);
  is_new_face_ = true;
}

void ImpulseProjection::solve(std::vector<BoundedPair>& pairs, Start start, std::int32_t iterations) {
  double fastest = 0;
  bool is_finite = true;
  for (BoundedPair& pair : pairs) {
    pair.change_n_s = 0;
    fastest = std::max(fastest, std::abs(pair.excess_m_s));
    is_finite = is_finite && std::isfinite(pair.excess_m_s);
  }
  if (!is_finite || fastest == 0) {
    for (BoundedPair& pair : pairs) pair.impulse_n_s = start == Start::kActing ? pair.impulse_n_s : 0;
    return;
  }
  set_rows(pairs);
  // In units of the fastest, so that no square leaves the range of doubles.
  q_.clear();
  gradient_.clear();
  direction_.assign(pairs.size(), 0);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    q_.push_back(pairs[i].impulse_n_s / rows_[i].scale / fastest);
    gradient_.push_back(-pairs[i].excess_m_s * rows_[i].scale / fastest);
  }
  if (start == Start::kGuess) {
    const double none = std::accumulate(gradient_.begin(), gradient_.end(), 0.0,
                                        [](double sum, double g) { return sum + (g < 0 ? g * g : 0); });
    first_m_s_ = std::sqrt(none) * fastest;
    take_guess();
  } else {
    add(kCompliance, q_, gradient_);
  }
  is_new_face_ = true;
  const double enough = kTolerance * first_m_s_ / fastest;
  for (std::int32_t iteration = 0; iteration < iterations; ++iteration) {
    const Left left = this->left();
    if (!(left.acting + left.missing > enough * enough)) break;
    if (left.missing > left.acting) {
      add_missing();
    } else {
      improve_acting();
    }
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const double impulse_n_s = q_[i] * rows_[i].scale * fastest;
    pairs[i].change_n_s = impulse_n_s - (start == Start::kActing ? pairs[i].impulse_n_s : 0);
    pairs[i].impulse_n_s = impulse_n_s;
  }
}

}  // namespace selvage::sim
