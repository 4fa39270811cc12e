// What one run of a stability case is given, and what it reports.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/types.h"

namespace selvage::bench {

struct Variant {
  int resolution = 0;  ///< 0 coarse, 1, 2 fine
  bool far = false;    ///< moved by a million lengths along every axis
  bool quick = false;  ///< few steps
};

/// A measured number and what the criterion asks of it.
struct Figure {
  std::string name;
  double value = 0, limit = 0;
  bool at_most = true;  ///< else at least

  [[nodiscard]] bool holds() const { return at_most ? value <= limit : value >= limit; }  // false for NaN
};

struct TrialReport {
  Variant variant;
  std::string failure;  ///< what did not hold first; "": the criterion holds
  std::int64_t vertices = 0, faces = 0;
  std::int64_t steps = 0;           ///< each checked exactly: the frame at its end, and the motion
  std::int64_t pairs_examined = 0;  ///< by the exact checker
  /// All features were at least this far apart at the end of every step, exactly; at most the thickness.
  double gap_at_least_m = std::numeric_limits<double>::infinity();
  std::int64_t steps_with_contact = 0;  ///< repulsions, or collisions
  std::int64_t steps_with_collisions = 0;
  std::int64_t pairs_below_tolerance = 0;  ///< named by the step's report
  std::int64_t fail_safe_steps = 0, fail_safe_vertices = 0;
  std::int64_t waiting_bodies = 0, cut_candidates = 0;
  std::vector<Figure> figures;
  double seconds = 0;  ///< processor time
};

/// Thrown by a criterion that does not hold: ends the trial, and is its verdict.
class CriterionFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Trial {
 public:
  explicit Trial(const Variant& variant) { report_.variant = variant; }

  /// The value for this trial's resolution.
  [[nodiscard]] int pick(int coarse, int middle, int fine) const;
  /// A number of steps: `full`, or `quick` in the short form.
  [[nodiscard]] int steps(int full, int quick) const { return report_.variant.quick ? quick : full; }
  /// Where the origin of the case lies, its lengths being about `length_m`.
  [[nodiscard]] Vec3 offset(double length_m) const;

  /// Throws CriterionFailed where it does not hold.
  void require(bool holds, const std::string& what);
  /// Records a figure; throws CriterionFailed where it is beyond the limit or NaN.
  void at_most(const std::string& name, double value, double limit) { judge({name, value, limit, true}); }
  void at_least(const std::string& name, double value, double limit) { judge({name, value, limit, false}); }

  [[nodiscard]] TrialReport& report() { return report_; }
  [[nodiscard]] const Variant& variant() const { return report_.variant; }

 private:
  void judge(const Figure& figure);

  TrialReport report_;
};

}  // namespace selvage::bench
