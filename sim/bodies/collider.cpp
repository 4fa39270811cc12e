#include "sim/bodies/collider.h"

#include <algorithm>

#include "kernel/assert.h"

namespace selvage::sim {
namespace {

struct CountRows {
  Eigen::Index operator()(const Collider::Rigid& rigid) const { return rigid.local.rows(); }
  Eigen::Index operator()(const Collider::Animated& animated) const { return animated.local->first().x.rows(); }
  Eigen::Index operator()(const Attachment& attachment) const { return attachment.count(); }
};

struct Place {
  double time_s;
  const Positions& x;

  Positions operator()(const Collider::Rigid& rigid) const { return transform(rigid.linkage.at(time_s), rigid.local); }
  Positions operator()(const Collider::Animated& animated) const {
    return transform(animated.linkage.at(time_s), animated.local->at(time_s));
  }
  Positions operator()(const Attachment& attachment) const { return attachment.placed_on(x); }
};

double distance_to_segment(const Vec3& x, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double squared = way.squaredNorm();
  const double share = squared > 0 ? std::clamp((x - from).dot(way) / squared, 0.0, 1.0) : 0;
  return (x - from - share * way).norm();
}

Eigen::AlignedBox3d box_of(const Positions& x) {
  return {x.colwise().minCoeff().transpose(), x.colwise().maxCoeff().transpose()};
}

}  // namespace

Collider::Collider(std::string name, std::vector<VertexId> vertices, Motion motion, double release_s,
                   std::optional<std::vector<Eigen::Index>> met)
    : name_(std::move(name)),
      vertices_(std::move(vertices)),
      motion_(std::move(motion)),
      release_s_(release_s),
      met_(std::move(met)) {
  SELVAGE_ASSERT(std::ssize(vertices_) == std::visit(CountRows{}, motion_));
}

const BodySequence* Collider::sequence() const {
  const auto* animated = std::get_if<Animated>(&motion_);
  return animated != nullptr ? animated->local.get() : nullptr;
}

Positions Collider::placed_at(double time_s, bool round_to_float32, const Positions& x) const {
  Positions placed = std::visit(Place{time_s, x}, motion_);
  if (round_to_float32) placed = placed.cast<float>().cast<double>().eval();
  return placed;
}

Collider::Bend Collider::bend(double t0_s, double t1_s) const {
  constexpr double kMostTurn_deg = 90;
  constexpr double kRounding = 0x1p-40;  // of places, however far out; thousands of times more than there is
  Bend bend;
  if ((met_ ? met_->empty() : vertices_.empty()) || std::holds_alternative<Attachment>(motion_)) return bend;
  const auto* rigid = std::get_if<Rigid>(&motion_);
  const Linkage& linkage = rigid != nullptr ? rigid->linkage : std::get<Animated>(motion_).linkage;
  const auto placed = [this](double time_s) {
    Positions all = placed_at(time_s, false, {});
    return met_ ? Positions(all(*met_, Eigen::all)) : all;
  };
  const Positions to = placed(t1_s), from = placed(t0_s);  // the first last: a sequence keeps two frames
  bend.within = box_of(from).merged(box_of(to));
  const double size_m = bend.within.min().cwiseAbs().cwiseMax(bend.within.max().cwiseAbs()).maxCoeff();
  std::vector<double> times = linkage.keys_between(t0_s, t1_s);
  if (const BodySequence* frames = sequence(); frames != nullptr) {
    const std::vector<double> own = frames->frames_between(t0_s, t1_s);
    times.insert(times.end(), own.begin(), own.end());
  }
  for (const double share : {0.25, 0.5, 0.75}) times.push_back(t0_s + share * (t1_s - t0_s));
  std::ranges::sort(times);  // so each frame is read once
  for (const double time_s : times) {
    const Positions between = placed(time_s);
    bend.within.extend(box_of(between));
    for (Eigen::Index i = 0; i < between.rows(); ++i) {
      const double away_m = distance_to_segment(between.row(i), from.row(i), to.row(i));
      if (away_m > kRounding * size_m) bend.leaves_line_by_m = std::max(bend.leaves_line_by_m, away_m);
    }
  }
  const bool turns_far = linkage.turn_deg(t0_s, t1_s) > kMostTurn_deg;
  if (turns_far) bend.leaves_line_by_m = std::numeric_limits<double>::infinity();
  // Between the samples: as far again as they are from each other, where they may have missed half of a turn.
  const Vec3 more = Vec3::Constant(turns_far ? bend.within.diagonal().norm() : bend.leaves_line_by_m);
  bend.within = {bend.within.min() - more, bend.within.max() + more};
  return bend;
}

void Collider::place_at(double time_s, bool round_to_float32, Positions& x) const {
  const Positions placed = placed_at(time_s, round_to_float32, x);
  for (std::size_t i = 0; i < vertices_.size(); ++i) x.row(vertices_[i]) = placed.row(static_cast<Eigen::Index>(i));
}

}  // namespace selvage::sim
