#include "sim/bodies/collider.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "kernel/assert.h"

namespace selvage::sim {
namespace {

struct CountRows {
  Eigen::Index operator()(const Collider::Rigid& rigid) const { return rigid.local.rows(); }
  Eigen::Index operator()(const Collider::Animated& animated) const { return animated.local->first().x.rows(); }
  Eigen::Index operator()(const Collider::Carried& carried) const { return carried.attachment.count(); }
};

struct Place {
  double time_s;
  const Positions& x;

  Positions operator()(const Collider::Rigid& rigid) const { return transform(rigid.linkage.at(time_s), rigid.local); }
  Positions operator()(const Collider::Animated& animated) const {
    return transform(animated.linkage.at(time_s), animated.local->at(time_s));
  }
  Positions operator()(const Collider::Carried& carried) const {
    return carried.attachment.placed_on(x.bottomRows(x.rows() - carried.body_begin));
  }
};

/// Points that move with a body: where they are when its vertices are at x.
using Follower = std::function<Positions(const Positions& x)>;

/// Of all followers while the script moves the body, which is placed once for each time.
std::vector<Passage> passages(const Collider& body, double t0_s, double t1_s, const std::vector<double>& times,
                              const std::vector<Follower>& followers) {
  const auto placed = [&](double time_s) { return body.placed_at(time_s, Precision::kFloat64, {}); };
  const Positions to = placed(t1_s);  // the first last: a sequence keeps two frames
  const Positions from = placed(t0_s), middle = placed((t0_s + t1_s) / 2);
  std::vector<Passage> passages;
  for (const Follower& follower : followers) {
    passages.emplace_back(follower(from), follower(middle), follower(to));
  }
  for (const double time_s : times) {
    const Positions at = placed(time_s);
    for (std::size_t i = 0; i < followers.size(); ++i) {
      passages[i].add((time_s - t0_s) / (t1_s - t0_s), followers[i](at));
    }
  }
  return passages;
}

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Where a body turns by more its ends say little of where it is between.
constexpr double kMaxTurn_deg = 90;
/// Such a body is looked at after so much of its turn again: at quarters of the step one that goes round four times in
/// it stood still. Beyond 512 looks, each of which places all its vertices, it is taken to be anywhere: the step is
/// halved, and with it what is to be looked at.
constexpr double kSampledTurn_deg = 45, kMaxSampledTurn_deg = 64 * 360;

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

Positions Collider::placed_at(double time_s, Precision precision, const Positions& x) const {
  return rounded(std::visit(Place{time_s, x}, motion_), precision);
}

std::optional<std::size_t> Collider::carrier() const {
  return carried() != nullptr ? std::optional(carried()->body) : std::nullopt;
}

const Linkage& Collider::linkage() const {
  SELVAGE_ASSERT(carried() == nullptr);
  const auto* const rigid = std::get_if<Rigid>(&motion_);
  return rigid != nullptr ? rigid->linkage : std::get<Animated>(motion_).linkage;
}

std::vector<double> Collider::times_between(double t0_s, double t1_s) const {
  std::vector<double> times = linkage().keys_between(t0_s, t1_s);
  if (const BodySequence* frames = sequence(); frames != nullptr) {
    const std::vector<double> own = frames->frames_between(t0_s, t1_s);
    times.insert(times.end(), own.begin(), own.end());
  }
  for (const double share : {0.25, 0.75}) times.push_back(t0_s + share * (t1_s - t0_s));
  std::ranges::sort(times);
  return times;
}

/// So many that it turns by kSampledTurn_deg from one to the next where it turns evenly between keys; else by three
/// times as much at most, as a cubic goes no faster than three times the length of its control polygon in its time.
void Collider::add_turns(double t0_s, double t1_s, std::vector<double>& times) const {
  std::vector<double> more;
  double from_s = t0_s;
  times.push_back(t1_s);
  for (const double to_s : times) {
    const double pieces = std::ceil(linkage().turn_deg(from_s, to_s) / kSampledTurn_deg);
    for (double piece = 1; piece < pieces; ++piece) more.push_back(from_s + piece / pieces * (to_s - from_s));
    from_s = to_s;
  }
  times.pop_back();
  times.insert(times.end(), more.begin(), more.end());
  std::ranges::sort(times);
}

Positions Collider::bow_m(double t0_s, double t1_s) const {
  if (vertices_.empty()) return Positions::Zero(0, 3);
  const auto all = [](const Positions& x) { return x; };
  return passages(*this, t0_s, t1_s, times_between(t0_s, t1_s), {all}).front().bow_m();
}

std::vector<Collider::Bend> Collider::bends(double t0_s, double t1_s, std::span<const Collider* const> carried) const {
  std::vector<Bend> bends(1 + carried.size());
  const bool is_met = met_ ? !met_->empty() : !vertices_.empty();
  if (!is_met && carried.empty()) return bends;
  const double turn_deg = linkage().turn_deg(t0_s, t1_s);
  if (turn_deg > kMaxSampledTurn_deg) {
    std::ranges::fill(bends, Bend{kInfinite, 0, {Vec3::Constant(-kInfinite), Vec3::Constant(kInfinite)}});
    return bends;
  }
  std::vector<double> times = times_between(t0_s, t1_s);
  const bool turns_far = turn_deg > kMaxTurn_deg;
  if (turns_far) add_turns(t0_s, t1_s, times);
  std::vector<Follower> followers;
  followers.push_back([&](const Positions& x) { return met_ && is_met ? Positions(x(*met_, Eigen::all)) : x; });
  for (const Collider* collider : carried) {
    followers.push_back([collider](const Positions& x) { return collider->carried()->attachment.placed_on(x); });
  }
  const std::vector<Passage> seen = passages(*this, t0_s, t1_s, times, followers);
  for (std::size_t i = 0; i < bends.size(); ++i) {
    if (i == 0 && !is_met) continue;
    Bend& bend = bends[i];
    bend.leaves_line_by_m = turns_far ? kInfinite : seen[i].leaves_line_by_m();
    bend.off_by_m = seen[i].off_by_m();
    bend.within = seen[i].box();
    // Between the samples: as far again as they are from each other, where they may have missed half of a turn.
    const Vec3 more = Vec3::Constant(turns_far ? bend.within.diagonal().norm() : bend.leaves_line_by_m);
    bend.within = {bend.within.min() - more, bend.within.max() + more};
  }
  return bends;
}

void Collider::place_at(double time_s, Precision precision, Positions& x) const {
  const Positions placed = placed_at(time_s, precision, x);
  for (std::size_t i = 0; i < vertices_.size(); ++i) x.row(vertices_[i]) = placed.row(static_cast<Eigen::Index>(i));
}

}  // namespace selvage::sim
