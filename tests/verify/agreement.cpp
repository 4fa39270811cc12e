#include "tests/verify/agreement.h"

#include <algorithm>
#include <ctime>
#include <functional>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/verify/motion_families.h"
#include "verify/decision/second_opinion.h"

namespace selvage::verify::testbed {
namespace {

enum class DeciderQuestion { kVf, kEe, kSelf };
constexpr DeciderQuestion kQuestions[] = {DeciderQuestion::kVf, DeciderQuestion::kEe, DeciderQuestion::kSelf};

/// A motion, and what is known of it from how it was made.
struct Drawn {
  MotionCase motion;
  std::optional<DeciderQuestion> hit;      ///< touches at this time or before
  double hit_time = 0;                     ///< rounded
  std::vector<DeciderQuestion> miss = {};  ///< do not touch
};

struct CaseClass {
  std::string name;
  std::function<Drawn(Draw&, int range)> draw;
  int divisor = 1;  ///< of the number of cases
  bool is_lattice = true;
};

std::vector<CaseClass> case_classes() {
  std::vector<CaseClass> classes;
  const auto add = [&classes](std::span<const Family> families, int divisor, bool is_lattice) {
    for (const Family& family : families) {
      classes.push_back({family.name,
                         [draw = family.draw](Draw& source, int range) {
                           return Drawn{draw(source, range), {}};
                         },
                         divisor, is_lattice});
    }
  };
  const auto add_hit = [&classes](const char* name, DeciderQuestion question, PlantedHit (*plant)(Draw&, int)) {
    classes.push_back({name, [=](Draw& source, int range) {
                         const PlantedHit hit = plant(source, range);
                         return Drawn{hit.motion, question, static_cast<double>(hit.numerator) / hit.denominator};
                       }});
  };
  add(lattice_families(), 1, true);
  add_hit("planted vf hit", DeciderQuestion::kVf, planted_vf_hit);
  add_hit("planted ee hit", DeciderQuestion::kEe, planted_ee_hit);
  add_hit("planted self hit", DeciderQuestion::kSelf, planted_self_hit);
  classes.push_back(
      {"planted vf gap", [](Draw& source, int range) {
         return Drawn{planted_miss(source, range, 1), {}, 0, {DeciderQuestion::kVf, DeciderQuestion::kSelf}};
       }});
  classes.push_back({"planted ee gap", [](Draw& source, int range) {
                       return Drawn{planted_miss(source, range, 2), {}, 0, {DeciderQuestion::kEe}};
                     }});
  add(double_families(), 20, false);
  add(whole_range_families(), 1000, false);
  return classes;
}

constexpr int kFewCases = 20;  // of a class that is slow, so that it is not dead in a short run

struct Answers {
  MotionAnswer first;
  SecondOpinion second;
};

Answers ask(DeciderQuestion question, const MotionCase& motion) {
  constexpr auto kDetail = Detail::kFirstTime;
  switch (question) {
    case DeciderQuestion::kVf:
      return {exact_vf_motion(motion.x_t0, motion.x_t1, kDetail), second_opinion_vf(motion.x_t0, motion.x_t1)};
    case DeciderQuestion::kEe:
      return {exact_ee_motion(motion.x_t0, motion.x_t1, kDetail), second_opinion_ee(motion.x_t0, motion.x_t1)};
    case DeciderQuestion::kSelf:
      return {exact_self_motion(motion.three_t0(), motion.three_t1(), kDetail),
              second_opinion_self(motion.three_t0(), motion.three_t1())};
  }
  throw std::logic_error("no such question");
}

/// Exact times, in intervals of doubles: certainly different ones do not overlap.
bool overlap(double a_lower, double a_upper, double b_lower, double b_upper) {
  return a_lower <= b_upper && b_lower <= a_upper;
}

/// The labels under which the features stay the same.
MotionCase relabelled(Draw& draw, DeciderQuestion question, const MotionCase& motion) {
  static constexpr std::array<std::size_t, 4> kVf[] = {
      {0, 2, 1, 3}, {0, 1, 3, 2}, {0, 3, 2, 1}, {0, 2, 3, 1}, {0, 3, 1, 2}};
  static constexpr std::array<std::size_t, 4> kEe[] = {
      {1, 0, 2, 3}, {0, 1, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}, {1, 0, 3, 2}};
  if (question == DeciderQuestion::kSelf) return reordered(motion, {0, 2, 1, 3});
  return reordered(motion, (question == DeciderQuestion::kVf ? kVf : kEe)[draw.integer(0, 4)]);
}

/// One class with one draw: asks, compares, counts; stops at the first disagreement.
class Comparison {
 public:
  Comparison(const CaseClass& what, std::uint64_t seed) : class_(what), draw_(seed) { tally_.name = what.name; }

  void run(int cases) {
    const std::clock_t begin = std::clock();
    for (int i = 0; i < cases && message_.empty(); ++i) {
      Drawn drawn = class_.draw(draw_, kRanges[i % std::ssize(kRanges)]);
      if (class_.is_lattice) {
        for (auto* points : {&drawn.motion.x_t0, &drawn.motion.x_t1}) {
          for (Point& p : *points) p = {2 * p[0], 2 * p[1], 2 * p[2]};
        }
      }
      for (const DeciderQuestion question : kQuestions) check(question, drawn, i);
    }
    tally_.cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  }
  [[nodiscard]] const ClassTally& tally() const { return tally_; }
  [[nodiscard]] const std::string& message() const { return message_; }

 private:
  static constexpr int kRanges[] = {1, 2, 3, 5, 10};

  void check(DeciderQuestion question, const Drawn& drawn, int round) {
    const Answers base = both(question, drawn.motion, tally_.drawn, "drawn");
    if (drawn.hit == question) {
      require(base.first.touches && base.first.first.lower_approx <= drawn.hit_time, question, drawn.motion,
              "planted hit");
      require(base.second.touches && base.second.first_lower <= drawn.hit_time, question, drawn.motion,
              "planted hit, second");
    }
    if (std::ranges::find(drawn.miss, question) != drawn.miss.end()) {
      require(!base.first.touches && !base.second.touches, question, drawn.motion, "planted gap");
    }
    if (round % 4 == 0) check_reversed(question, drawn.motion, base);
    if (round % 4 == 1) check_relabelled(question, drawn.motion, base);
    if (round % 4 == 2 && class_.is_lattice) check_halves(question, drawn.motion, base);
  }

  void check_reversed(DeciderQuestion question, const MotionCase& motion, const Answers& base) {
    const Answers back = both(question, {motion.x_t1, motion.x_t0}, tally_.related, "reversed");
    require(back.first.touches == base.first.touches, question, motion, "time reversal");
    require(back.second.touches == base.second.touches, question, motion, "time reversal, second");
  }

  void check_relabelled(DeciderQuestion question, const MotionCase& motion, const Answers& base) {
    const Answers other = both(question, relabelled(draw_, question, motion), tally_.related, "relabelled");
    require(other.first.touches == base.first.touches && other.first.kind == base.first.kind &&
                other.first.first.lower == base.first.first.lower && other.first.first.upper == base.first.first.upper,
            question, motion, "relabelling");
    require(other.second.touches == base.second.touches &&
                (!base.second.touches || overlap(other.second.first_lower, other.second.first_upper,
                                                 base.second.first_lower, base.second.first_upper)),
            question, motion, "relabelling, second");
  }

  /// The whole touches iff a half does; first in the first half that does.
  void check_halves(DeciderQuestion question, const MotionCase& motion, const Answers& base) {
    const Answers first = both(question, half(motion, false), tally_.related, "first half");
    const Answers second = both(question, half(motion, true), tally_.related, "second half");
    require(base.first.touches == (first.first.touches || second.first.touches), question, motion, "halves");
    require(base.second.touches == (first.second.touches || second.second.touches), question, motion, "halves, second");
    if (!base.second.touches || !base.first.touches) return;
    const double offset = first.second.touches ? 0 : 1;
    const Answers& touching = first.second.touches ? first : second;
    const ExactTime &whole = base.first.first, &part = touching.first.first;
    require(
        overlap(2 * whole.lower_approx - offset, 2 * whole.upper_approx - offset, part.lower_approx, part.upper_approx),
        question, motion, "time in a half");
    require(overlap(2 * base.second.first_lower - offset, 2 * base.second.first_upper - offset,
                    touching.second.first_lower, touching.second.first_upper),
            question, motion, "time in a half, second");
  }

  Answers both(DeciderQuestion question, const MotionCase& motion, std::int64_t& count, const char* what) {
    const Answers answers = ask(question, motion);
    const auto& [first, second] = answers;
    ++count;
    tally_.touches += first.touches ? 1 : 0;
    tally_.unfiltered += first.exact_used ? 1 : 0;
    tally_.inside += first.touches && first.first.lower_approx > 0 && first.first.upper_approx < 1 ? 1 : 0;
    require(first.touches == second.touches, question, motion, what);
    require(!first.touches || !second.touches ||
                overlap(first.first.lower_approx, first.first.upper_approx, second.first_lower, second.first_upper),
            question, motion, what);
    return answers;
  }

  void require(bool holds, DeciderQuestion question, const MotionCase& motion, const char* what) {
    if (holds || !message_.empty()) return;
    std::ostringstream text;
    text << class_.name << ": " << what << ", question " << static_cast<int>(question) << ", after "
         << tally_.drawn + tally_.related << " queries" << motion;
    message_ = text.str();
  }

  const CaseClass& class_;
  Draw draw_;
  ClassTally tally_;
  std::string message_;
};

}  // namespace

Agreement compare_deciders(std::uint64_t seed, int cases) {
  Agreement agreement;
  for (const CaseClass& what : case_classes()) {
    Comparison comparison(what, seed);
    comparison.run(std::max(std::min(cases, kFewCases), cases / what.divisor));
    agreement.classes.push_back(comparison.tally());
    if (!comparison.message().empty()) agreement.disagreements.push_back(comparison.message());
  }
  return agreement;
}

}  // namespace selvage::verify::testbed
