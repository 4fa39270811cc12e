#include "sim/bodies/collider.h"

#include <algorithm>
#include <cmath>

#include "kernel/assert.h"

namespace selvage::sim {
namespace {

struct CountRows {
  Eigen::Index operator()(const Collider::Rigid& rigid) const { return rigid.local.rows(); }
  Eigen::Index operator()(const Collider::Animated& animated) const { return animated.local->first().x.rows(); }
};

Eigen::Index rows_of(const Collider::Script& script) { return std::visit(CountRows{}, script); }

struct Place {
  double time_s;

  Positions operator()(const Collider::Rigid& rigid) const { return transform(rigid.linkage.at(time_s), rigid.local); }
  Positions operator()(const Collider::Animated& animated) const {
    return transform(animated.linkage.at(time_s), animated.local->at(time_s));
  }
};

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
  const Carried* const carried = carry();
  SELVAGE_ASSERT(std::ssize(vertices_) == (carried != nullptr ? carried->attachment.count() : rows_of(script())));
}

const Collider::Script& Collider::script() const {
  const Carried* const carried = carry();
  return carried != nullptr ? carried->body : std::get<Script>(motion_);
}

bool Collider::deforms() const { return carry() != nullptr || std::holds_alternative<Animated>(script()); }

const BodySequence* Collider::sequence() const {
  const auto* animated = std::get_if<Animated>(&script());
  return animated != nullptr && carry() == nullptr ? animated->local.get() : nullptr;
}

Positions Collider::placed_at(double time_s, bool round_to_float32, const Positions& x) const {
  const Carried* const carried = carry();
  Positions placed = carried != nullptr
                         ? carried->attachment.placed_on(x.middleRows(carried->body_begin, rows_of(carried->body)))
                         : std::visit(Place{time_s}, script());
  if (round_to_float32) placed = placed.cast<float>().cast<double>().eval();
  return placed;
}

Positions Collider::scripted_at(double time_s) const {
  Positions placed = std::visit(Place{time_s}, script());
  const Carried* const carried = carry();
  return carried != nullptr ? carried->attachment.placed_on(placed) : placed;
}

const Linkage& Collider::linkage() const {
  return std::visit([](const auto& motion) -> const Linkage& { return motion.linkage; }, script());
}

std::vector<double> Collider::times_between(double t0_s, double t1_s) const {
  std::vector<double> times = linkage().keys_between(t0_s, t1_s);
  if (const auto* animated = std::get_if<Animated>(&script())) {
    const std::vector<double> frames = animated->local->frames_between(t0_s, t1_s);
    times.insert(times.end(), frames.begin(), frames.end());
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

Passage Collider::passage(double t0_s, double t1_s, const std::vector<double>& times, Rows rows) const {
  const auto placed = [&](double time_s) {
    Positions all = scripted_at(time_s);
    return rows == Rows::kMet && met_ ? Positions(all(*met_, Eigen::all)) : all;
  };
  const Positions to = placed(t1_s);  // the first last: a sequence keeps two frames
  Positions from = placed(t0_s);
  Passage passage(std::move(from), placed((t0_s + t1_s) / 2), to);
  for (const double time_s : times) passage.add((time_s - t0_s) / (t1_s - t0_s), placed(time_s));
  return passage;
}

Positions Collider::bow_m(double t0_s, double t1_s) const {
  if (vertices_.empty()) return Positions::Zero(0, 3);
  return passage(t0_s, t1_s, times_between(t0_s, t1_s), Rows::kAll).bow_m();
}

Collider::Bend Collider::bend(double t0_s, double t1_s) const {
  Bend bend;
  if (met_ ? met_->empty() : vertices_.empty()) return bend;
  std::vector<double> times = times_between(t0_s, t1_s);
  const double turn_deg = linkage().turn_deg(t0_s, t1_s);
  const bool turns_far = turn_deg > kMaxTurn_deg;
  if (turn_deg > kMaxSampledTurn_deg) return {kInfinite, 0, {Vec3::Constant(-kInfinite), Vec3::Constant(kInfinite)}};
  if (turns_far) add_turns(t0_s, t1_s, times);
  const Passage seen = passage(t0_s, t1_s, times, Rows::kMet);
  bend.leaves_line_by_m = turns_far ? kInfinite : seen.leaves_line_by_m();
  bend.off_by_m = seen.off_by_m();
  bend.within = seen.box();
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
