// The exact checker (V1, V3): relations, planted answers, deciders that were written differently.
#include <cmath>
#include <limits>

#include "tests/mutants/properties.h"
#include "tests/verify/frame_plants.h"
#include "tests/verify/frames.h"
#include "tests/verify/motion_relations.h"
#include "tests/verify/overlap_families.h"
#include "tests/verify/overlap_reference.h"
#include "verify/arithmetic/fp_guard.h"
#include "verify/decision/contact.h"
#include "verify/filter/motion_filter.h"

namespace selvage::mutants {
namespace {

using verify::Point;
using verify::testbed::Draw;
using verify::testbed::MotionCase;

MotionCase any_whole_motion(Draw& draw) {
  const auto families = verify::testbed::lattice_families();
  const int range = draw.integer(1, 5), which = draw.integer(0, static_cast<int>(families.size()) + 1);
  if (which < static_cast<int>(families.size())) return families[static_cast<std::size_t>(which)].draw(draw, range);
  const bool vf = which == static_cast<int>(families.size());
  return (vf ? verify::testbed::planted_vf_hit(draw, range) : verify::testbed::planted_ee_hit(draw, range)).motion;
}

MotionCase any_motion(Draw& draw) {
  const auto families = verify::testbed::double_families();
  const int which = draw.integer(0, 2 * static_cast<int>(families.size()) - 1);
  if (which >= static_cast<int>(families.size())) return any_whole_motion(draw);
  return families[static_cast<std::size_t>(which)].draw(draw, draw.integer(1, 5));
}

std::string broken_relation(std::uint64_t seed) {
  Draw draw(seed);
  const MotionCase motion = any_whole_motion(draw);
  for (std::string what :
       {verify::testbed::broken_by_time_reversal(motion), verify::testbed::broken_by_order(motion),
        verify::testbed::broken_by_maps(motion), verify::testbed::broken_by_common_motion(motion, draw),
        verify::testbed::broken_by_split(motion)}) {
    if (!what.empty()) return what;
  }
  return "";
}

/// The touch is found, not after the time that it was planted at.
bool is_found(const verify::testbed::PlantedHit& hit, const verify::MotionAnswer& answer) {
  return answer.touches && answer.first.lower_approx * hit.denominator <= hit.numerator;
}

std::string judge_planted_motions(std::uint64_t seed) {
  using namespace verify::testbed;
  constexpr auto kDetail = verify::Detail::kFirstTime;
  Draw draw(seed);
  const int range = draw.integer(1, 6);
  const PlantedHit vf = planted_vf_hit(draw, range), ee = planted_ee_hit(draw, range);
  if (!is_found(vf, exact_vf_motion(vf.motion.x_t0, vf.motion.x_t1, kDetail))) return "planted hit, vf";
  if (!is_found(ee, exact_ee_motion(ee.motion.x_t0, ee.motion.x_t1, kDetail))) return "planted hit, ee";
  const PlantedHit self = planted_self_hit(draw, range);
  if (!is_found(self, verify::exact_self_motion(self.motion.three_t0(), self.motion.three_t1(), kDetail))) {
    return "planted hit, self";
  }
  const MotionCase one = planted_miss(draw, range, 1), two = planted_miss(draw, range, 2);
  if (exact_vf_motion(one.x_t0, one.x_t1, verify::Detail::kDecision).touches) return "planted miss, vf";
  if (exact_ee_motion(two.x_t0, two.x_t1, verify::Detail::kDecision).touches) return "planted miss, ee";
  return "";
}

bool agree(const verify::MotionAnswer& answer, const verify::SecondOpinion& second) {
  if (answer.touches != second.touches) return false;
  return !second.touches ||
         (answer.first.lower_approx <= second.first_upper && second.first_lower <= answer.first.upper_approx);
}

std::string compare_deciders(std::uint64_t seed) {
  constexpr auto kDetail = verify::Detail::kFirstTime;
  Draw draw(seed);
  const MotionCase motion = any_motion(draw);
  const auto& [x_t0, x_t1] = motion;
  if (!agree(exact_vf_motion(x_t0, x_t1, kDetail), verify::second_opinion_vf(x_t0, x_t1))) return "deciders differ, vf";
  if (!agree(exact_ee_motion(x_t0, x_t1, kDetail), verify::second_opinion_ee(x_t0, x_t1))) return "deciders differ, ee";
  return "";
}

bool contradicts(verify::MotionTriage triage, const std::optional<verify::FirstTouch>& exact) {
  if (triage == verify::MotionTriage::kUnresolved) return false;
  return triage == verify::MotionTriage::kApart ? exact.has_value() : !exact || !exact->is_cross;
}

std::string judge_filter(std::uint64_t seed) {
  const verify::FpGuard guard;
  Draw draw(seed);
  const MotionCase motion = any_motion(draw);
  const auto& [x_t0, x_t1] = motion;
  const auto points = verify::moving_points(x_t0, x_t1);
  if (contradicts(verify::triage_vf_motion(x_t0, x_t1), verify::first_vf_touch(points)))
    return "the filter is wrong, vf";
  if (contradicts(verify::triage_ee_motion(x_t0, x_t1), verify::first_ee_touch(points)))
    return "the filter is wrong, ee";
  return "";
}

verify::CheckResult check(const io::MeshData& mesh) {
  verify::CheckOptions options;
  options.max_violations = 1000000;
  return verify::check_frame(testing::surface(mesh), mesh.points, options);
}

/// A clean sheet, then the same with one or two things planted: what is reported is what was planted.
std::string judge_plants(std::uint64_t seed) {
  using verify::testbed::kPlants;
  Draw draw(seed);
  io::MeshData mesh = testing::sheet(draw.integer(3, 24));
  if (check(mesh).violations_total.total() != 0) return "a clean sheet is not clean";
  const auto faces = static_cast<int>(mesh.triangles.size());
  const int face = draw.integer(0, faces - 1);
  std::set<std::string> expected;
  for (const int at : {face, (face + faces / 2) % faces}) {
    expected.merge(
        kPlants[draw.integer(0, static_cast<int>(std::size(kPlants)) - 1)].spoil(mesh, static_cast<std::size_t>(at)));
  }
  const verify::CheckResult result = check(mesh);
  if (result.violations_total.total() < static_cast<std::int64_t>(expected.size()))
    return "a planted violation is lost";
  return verify::testbed::texts(result) == expected ? "" : "other violations than planted";
}

std::string judge_overlap(std::uint64_t seed) {
  using namespace verify::testbed;
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  const OverlapFamily family = kOverlapFamilies[random() % std::size(kOverlapFamilies)];
  const int range = 1 + static_cast<int>(random() % 4), shared = static_cast<int>(random() % 3);
  const TwoTriangles c = from_points(draw(random, family, range), shared);
  const auto kind = verify::exact_overlap(c.face_a, c.a, c.face_b, c.b).kind;
  const auto expected = verify::reference::overlap(c.face_a, c.a, c.face_b, c.b);
  return kind == expected ? "" : std::string(verify::name_of(kind)) + " for " + verify::name_of(expected);
}

/// A corner exactly on another face, in numbers so long that heights over the face round.
std::string judge_long_touches(std::uint64_t seed) {
  Draw draw(seed);
  const auto number = [&] { return 4.0 * draw.integer(-(1 << 24), 1 << 24); };
  io::MeshData mesh;
  for (int v = 0; v < 3; ++v) mesh.points.push_back({number(), number(), number()});
  mesh.triangles.push_back({0, 1, 2});
  const Point touch = testing::point_on(mesh, 0, {1, 1, 2});
  mesh.points.push_back(touch);
  mesh.points.push_back({touch[0] + 1, touch[1], touch[2] + 0x1p+28});
  mesh.points.push_back({touch[0], touch[1] + 1, touch[2] + 0x1p+28});
  mesh.triangles.push_back({3, 4, 5});
  return verify::testbed::texts(check(mesh)) == std::set<std::string>{"overlap touch 0 1"} ? "" : "a touch is lost";
}

/// Sheets one after another, at rest; one of them may be spoilt, or not be made of numbers.
std::string judge_sequence(std::uint64_t seed) {
  Draw draw(seed);
  io::MeshData clean = testing::sheet(draw.integer(2, 4));
  const bool has_loose = draw.chance(50);
  if (has_loose) clean.points.push_back({0, 0, 9});  // a vertex that no face holds
  std::vector<io::MeshData> frames(static_cast<std::size_t>(draw.integer(1, 4)), clean);
  const int spoilt = draw.integer(-1, static_cast<int>(frames.size()) - 1);
  const bool is_bad_number = draw.chance(30);
  if (spoilt >= 0) {
    auto& points = frames[static_cast<std::size_t>(spoilt)].points;
    Point& corner = is_bad_number && has_loose ? points.back() : points.front();
    // The first corner of the sheet, put onto the last face.
    if (is_bad_number) corner[0] = draw.chance(50) ? std::nan("") : std::numeric_limits<double>::infinity();
    if (!is_bad_number) corner = testing::point_on(clean, clean.triangles.size() - 1, {1, 1, 2});
  }
  verify::SequenceOptions options;
  options.motions = false;
  try {
    const auto report = verify::check_sequence(testing::Frames(frames), options);
    if (spoilt >= 0 && is_bad_number) return "what is not a number is checked";
    const auto expected = spoilt >= 0 ? verify::Verdict::kViolated : verify::Verdict::kClean;
    if (report.verdict != expected) return "another verdict";
    for (const verify::Violation& violation : report.violations) {
      if (violation.frame != spoilt) return "another frame is named";
    }
    if (report.frames.checked != static_cast<std::int64_t>(frames.size())) return "frames are left out";
  } catch (const std::invalid_argument&) {
    if (spoilt < 0 || !is_bad_number) return "good frames are refused";
  }
  return "";
}

}  // namespace

std::vector<Property> checker_properties() {
  return {{"motion-relations", "reversal, relabelling, maps of space and cutting the time change no exact answer (V1)",
           falsify<broken_relation>},
          {"planted-motions", "planted hits are found in time, planted misses are not reported (V1)",
           falsify<judge_planted_motions>},
          {"two-deciders", "the checker and CGAL's algebraic kernel decide alike (V1)", falsify<compare_deciders>},
          {"filter", "the filter of motions never contradicts the exact decision (V1)", falsify<judge_filter>},
          {"frame-plants", "what is planted into a clean sheet is found and named, and nothing else (V1)",
           falsify<judge_plants>},
          {"overlap", "two triangles overlap as polygons in rationals do (V1)", falsify<judge_overlap>},
          {"long-touches", "a corner on a face in long numbers is found (V1)", falsify<judge_long_touches>},
          {"sequence", "a sequence is clean, violated or refused as its frames are (V3)", falsify<judge_sequence>}};
}

}  // namespace selvage::mutants
