#include "fuzz/shrink/shrink_query.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

#include "fuzz/base/short_numbers.h"

namespace selvage::fuzz {
namespace {

/// The coordinates that mean something: both ends of every point of the kind.
class Coordinates {
 public:
  explicit Coordinates(PairKind kind) : points_(static_cast<std::size_t>(point_count(kind))) {}
  [[nodiscard]] std::size_t size() const { return 6 * points_; }
  static double& at(MotionQuery& query, std::size_t i) {
    auto& x = i % 2 == 0 ? query.x_t0 : query.x_t1;  // the ends of one coordinate are neighbours
    return x[i / 6][static_cast<Eigen::Index>(i / 2 % 3)];
  }
  [[nodiscard]] std::size_t points() const { return points_; }

 private:
  std::size_t points_;
};

class Shrinker {
 public:
  Shrinker(const MotionQuery& query, const std::function<bool(const MotionQuery&)>& still_fails,
           std::int64_t max_trials)
      : best_{query, 0}, cost_(cost_of(query)), still_fails_(still_fails), max_trials_(max_trials), all_(query.kind) {}

  Shrunk run() {
    bool progress = true;
    while (progress && best_.trials < max_trials_) {
      const QueryCost before = cost_;
      whole_query();
      points();
      coordinates();
      rounding();
      scaling();
      options();
      progress = cost_ < before;
    }
    return best_;
  }

 private:
  /// Takes `simpler` if it is cheaper, or its options are simpler and it costs the same, and it still fails.
  bool offer(MotionQuery simpler, bool simpler_options = false) {
    if (simpler.kind == PairKind::kSelf) {
      simpler.x_t0[3] = simpler.x_t0[0];
      simpler.x_t1[3] = simpler.x_t1[0];
    }
    const QueryCost cost = cost_of(simpler);
    if (!(cost < cost_ || (simpler_options && cost == cost_)) || best_.trials >= max_trials_) return false;
    if (!is_in_domain(simpler)) return false;
    ++best_.trials;
    if (!still_fails_(simpler)) return false;
    best_.query = simpler;
    cost_ = cost;
    return true;
  }

  void whole_query() {
    MotionQuery still = best_.query;
    still.x_t0 = still.x_t1;
    (void)offer(still);
    still = best_.query;
    still.x_t1 = still.x_t0;
    (void)offer(still);
    for (std::size_t origin = 0; origin < all_.points(); ++origin) {
      for (const auto* end : {&best_.query.x_t0, &best_.query.x_t1}) {
        const Vec3 offset = (*end)[origin];
        MotionQuery moved = best_.query;
        for (auto* x : {&moved.x_t0, &moved.x_t1}) {
          for (Vec3& point : *x) point -= offset;
        }
        if (offer(moved)) break;  // `end` now points at other numbers
      }
    }
  }

  void points() {
    for (std::size_t i = 0; i < all_.points(); ++i) {
      MotionQuery simpler = best_.query;
      simpler.x_t1[i] = simpler.x_t0[i];
      if (!offer(simpler)) {
        simpler = best_.query;
        simpler.x_t0[i] = simpler.x_t1[i];
        (void)offer(simpler);
      }
      for (std::size_t j = 0; j < all_.points(); ++j) {
        simpler = best_.query;
        simpler.x_t0[i] = simpler.x_t0[j];
        simpler.x_t1[i] = simpler.x_t1[j];
        (void)offer(simpler);
      }
    }
  }

  void coordinates() {
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (set(i, 0)) continue;
      // Both ends at once: a coordinate that the whole point does without.
      MotionQuery flat = best_.query;
      Coordinates::at(flat, i) = Coordinates::at(flat, i ^ 1U) = 0;
      if (offer(flat)) continue;
      (void)set(i, 1);
      for (std::size_t j = 0; j < all_.size(); ++j) {
        if (j != i) (void)set(i, Coordinates::at(best_.query, j));
      }
    }
  }

  void rounding() {
    for (const int bits : kShortBits) {  // all at once, then one by one
      MotionQuery rounded = best_.query;
      for (std::size_t i = 0; i < all_.size(); ++i) {
        double& x = Coordinates::at(rounded, i);
        x = round_to_bits(x, bits);
      }
      if (offer(rounded)) break;
    }
    for (std::size_t i = 0; i < all_.size(); ++i) {
      for (const int bits : kShortBits) {
        if (set(i, round_to_bits(Coordinates::at(best_.query, i), bits))) break;
      }
    }
  }

  /// So that the largest coordinate is about 1, or half as far as that.
  void scaling() {
    const double largest = max_coordinate(best_.query);
    if (!(largest > 0) || !std::isfinite(largest)) return;  // which have no exponent
    for (int exponent = -std::ilogb(largest); exponent != 0; exponent /= 2) {
      MotionQuery scaled = best_.query;
      for (std::size_t i = 0; i < all_.size(); ++i) {
        double& x = Coordinates::at(scaled, i);
        x = std::ldexp(x, exponent);
      }
      scaled.options.tolerance = std::ldexp(scaled.options.tolerance, exponent);
      if (offer(scaled)) return;
    }
  }

  void options() {
    const CcdOptions now = best_.query.options;
    for (const double tolerance : {0.0, round_to_bits(now.tolerance, 1), round_to_bits(now.tolerance, 4)}) {
      if (tolerance == best_.query.options.tolerance) break;
      MotionQuery simpler = best_.query;
      simpler.options.tolerance = tolerance;
      if (offer(simpler, true)) break;
    }
    if (now.max_intervals != CcdOptions{}.max_intervals) {
      MotionQuery simpler = best_.query;
      simpler.options.max_intervals = CcdOptions{}.max_intervals;
      (void)offer(simpler, true);
    }
  }

  bool set(std::size_t i, double x) {
    MotionQuery simpler = best_.query;
    if (Coordinates::at(simpler, i) == x) return false;
    Coordinates::at(simpler, i) = x;
    return offer(simpler);
  }

  Shrunk best_;
  QueryCost cost_;
  const std::function<bool(const MotionQuery&)>& still_fails_;
  std::int64_t max_trials_;
  Coordinates all_;
};

}  // namespace

QueryCost cost_of(const MotionQuery& query) {
  MotionQuery copy = query;
  const Coordinates all(query.kind);
  QueryCost cost;
  std::set<double> distinct;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double x = Coordinates::at(copy, i);
    if (i % 2 == 0 && x != Coordinates::at(copy, i + 1)) ++cost.moving;
    if (x == 0) continue;
    ++cost.non_zero;
    cost.bits += mantissa_bits(x);
    if (!std::isfinite(x)) continue;  // NaN has no place in an order
    distinct.insert(std::abs(x));
    cost.exponents += std::abs(std::ilogb(x));
  }
  cost.distinct = static_cast<int>(distinct.size());
  return cost;
}

Shrunk shrink(const MotionQuery& query, const std::function<bool(const MotionQuery&)>& still_fails,
              std::int64_t max_trials) {
  return Shrinker(query, still_fails, max_trials).run();
}

}  // namespace selvage::fuzz
