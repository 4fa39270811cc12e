#include "sim/bodies/passage.h"

#include <algorithm>
#include <utility>

namespace selvage::sim {
namespace {

/// Of the parabola's height, as far as it may be off. A body that starts or stops anywhere in the step is off by a
/// quarter of it or more; one that moves smoothly from rest to rest in n steps by 1 / (8 (n - 1)) in the first and the
/// last (cubic keys), and a vertex that goes round by an angle of a radians by a / 16.
constexpr double kMaxOff = 1.0 / 8;

double distance_to_segment(const Vec3& x, const Vec3& from, const Vec3& way) {
  const double squared = way.squaredNorm();
  const double share = squared > 0 ? std::clamp((x - from).dot(way) / squared, 0.0, 1.0) : 0;
  return (x - from - share * way).norm();
}

Eigen::AlignedBox3d box_of(const Positions& x) {
  return {x.colwise().minCoeff().transpose(), x.colwise().maxCoeff().transpose()};
}

double longest(const Positions& rows) { return rows.rows() > 0 ? rows.rowwise().norm().maxCoeff() : 0; }

}  // namespace

Passage::Passage(Positions from, const Positions& middle, const Positions& to)
    : from_(std::move(from)),
      way_(to - from_),
      bow_(2 * (from_ + to) - 4 * middle),
      box_(box_of(from_).merged(box_of(to))) {
  rounding_m_ = 0x1p-40 * box_.min().cwiseAbs().cwiseMax(box_.max().cwiseAbs()).maxCoeff();
  add(0.5, middle);
}

void Passage::add(double share, const Positions& at) {
  const Positions off = at - from_ - share * way_;
  line_is_off_by_m_ = std::max(line_is_off_by_m_, longest(off));
  bow_is_off_by_m_ = std::max(bow_is_off_by_m_, longest(off + share * (1 - share) * bow_));
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    leaves_line_by_m_ = std::max(leaves_line_by_m_, distance_to_segment(at.row(i), from_.row(i), way_.row(i)));
  }
  box_.extend(box_of(at));
}

bool Passage::is_bow() const { return unless_rounding(bow_is_off_by_m_) <= kMaxOff / 4 * longest(bow_); }

Positions Passage::bow_m() const { return is_bow() ? bow_ : Positions::Zero(bow_.rows(), 3); }

double Passage::off_by_m() const { return unless_rounding(is_bow() ? bow_is_off_by_m_ : line_is_off_by_m_); }

double Passage::leaves_line_by_m() const { return unless_rounding(leaves_line_by_m_); }

}  // namespace selvage::sim
