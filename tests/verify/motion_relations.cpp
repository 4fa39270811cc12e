#include "tests/verify/motion_relations.h"

#include <functional>

#include "verify/decision/contact.h"

namespace selvage::verify::testbed {
namespace {

enum class Question { kVf, kEe };
constexpr std::array<Question, 2> kBoth = {Question::kVf, Question::kEe};

std::optional<FirstTouch> first_touch(Question question, const MotionCase& motion) {
  const auto points = moving_points(motion.x_t0, motion.x_t1);
  return question == Question::kVf ? first_vf_touch(points) : first_ee_touch(points);
}

std::string broken(Question question, const char* relation) {
  return std::string(relation) + (question == Question::kVf ? ", vf" : ", ee");
}

/// The same touches at the same time.
std::string difference(Question question, const MotionCase& a, const MotionCase& b, const char* relation) {
  auto first = first_touch(question, a), second = first_touch(question, b);
  const bool same = first.has_value() == second.has_value() &&
                    (!first || (compare(first->instant, second->instant) == 0 && first->is_cross == second->is_cross));
  return same ? "" : broken(question, relation);
}

template <class Change>
MotionCase mapped(MotionCase motion, const Change& change) {
  for (auto* points : {&motion.x_t0, &motion.x_t1}) {
    for (Point& point : *points) point = change(point);
  }
  return motion;
}

/// The same motion as long as 2/3: an instant with a power of two below the line has none there. REQUIRES multiples
/// of 3.
MotionCase until_two_thirds(const MotionCase& motion) {
  MotionCase result = motion;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result.x_t1[i][k] = (motion.x_t0[i][k] + 2 * motion.x_t1[i][k]) / 3;
  }
  return result;
}

}  // namespace

std::string broken_by_time_reversal(const MotionCase& motion) {
  for (const Question question : kBoth) {
    if (first_touch(question, motion).has_value() != first_touch(question, {motion.x_t1, motion.x_t0}).has_value()) {
      return broken(question, "time reversal");
    }
  }
  return "";
}

std::string broken_by_order(const MotionCase& motion) {
  for (const auto& order :
       {std::array<std::size_t, 4>{0, 2, 1, 3}, {0, 1, 3, 2}, {0, 3, 2, 1}, {0, 2, 3, 1}, {0, 3, 1, 2}}) {
    if (auto what = difference(Question::kVf, motion, reordered(motion, order), "corners"); !what.empty()) return what;
  }
  for (const auto& order : {std::array<std::size_t, 4>{1, 0, 2, 3}, {0, 1, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}) {
    auto what = difference(Question::kEe, motion, reordered(motion, order), "ends and edges");
    if (!what.empty()) return what;
  }
  return "";
}

std::string broken_by_maps(const MotionCase& motion) {
  struct Map {
    const char* relation;
    Point (*map)(const Point& p);
  };
  constexpr Map kMaps[] = {{"axis cycle",
                            [](const Point& p) {
                              return Point{p[1], p[2], p[0]};
                            }},
                           {"scale by 8",
                            [](const Point& p) {
                              return Point{8 * p[0], 8 * p[1], 8 * p[2]};
                            }},
                           {"reflection",
                            [](const Point& p) {
                              return Point{-p[0], p[1], p[2]};
                            }},
                           {"3-4-5 rotation, times 5",
                            [](const Point& p) {
                              return Point{3 * p[0] - 4 * p[1], 4 * p[0] + 3 * p[1], 5 * p[2]};
                            }},
                           {"shear", [](const Point& p) {
                              return Point{p[0] + 2 * p[1], p[1], p[2] - p[0]};
                            }}};
  for (const Question question : kBoth) {
    for (const auto& [relation, map] : kMaps) {
      if (auto what = difference(question, motion, mapped(motion, map), relation); !what.empty()) return what;
    }
  }
  return "";
}

std::string broken_by_common_motion(const MotionCase& motion, Draw& shifts) {
  MotionCase moved = motion;
  const Point first = shifts.point(1000), last = shifts.point(1000);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      moved.x_t0[i][k] += first[k];
      moved.x_t1[i][k] += last[k];
    }
  }
  for (const Question question : kBoth) {
    if (auto what = difference(question, motion, moved, "common motion"); !what.empty()) return what;
  }
  return "";
}

std::string broken_by_split(const MotionCase& drawn) {
  const MotionCase motion = mapped(drawn, [](const Point& p) { return Point{6 * p[0], 6 * p[1], 6 * p[2]}; });
  for (const Question question : kBoth) {
    const auto whole = first_touch(question, motion);
    auto first = first_touch(question, half(motion, false)), second = first_touch(question, half(motion, true));
    if (whole.has_value() != (first || second)) return broken(question, "split");
    auto two_thirds = first_touch(question, until_two_thirds(motion));
    if (two_thirds && !whole) return broken(question, "split at 2/3");
    if (!whole) continue;
    // The whole one's first time, against the middle.
    Instant middle = Instant::dyadic(1, 1), time = whole->instant, end = Instant::end();
    const int side = compare(time, middle);
    if ((side <= 0) != first.has_value()) return broken(question, "split, the half");
    // No crossing is lost or invented where the parts do not cut it.
    if (first && side < 0 && whole->is_cross != first->is_cross) return broken(question, "split, first crossing");
    if (!first && side > 0 && whole->is_cross != second->is_cross) return broken(question, "split, second crossing");
    if (two_thirds && compare(two_thirds->instant, end) < 0 && whole->is_cross != two_thirds->is_cross) {
      return broken(question, "split at 2/3, crossing");
    }
  }
  return "";
}

}  // namespace selvage::verify::testbed
