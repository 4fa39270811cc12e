// The culls alone, on constructed contacts: no oracle and no search, so that a campaign of many cases costs little.
// What a cull wrongly separates is seldom, for its bounds are wide and few queries come near them.
#include "fuzz/draw/contact.h"
#include "kernel/fp_env.h"
#include "kernel/lanes/lane_cull.h"
#include "kernel/query/cull.h"
#include "tests/kernel/pair_list.h"
#include "tests/mutants/properties.h"

namespace selvage::mutants {
namespace {

/// Large features that hardly move, do not turn, and touch at the start or the end: their plane supports the whole
/// sweep, and bounds and rounding errors are as large as they get beside the motion.
fuzz::MotionQuery draw_contact(std::uint64_t seed) {
  fuzz::ChoiceSource source = fuzz::ChoiceSource::from_seed(seed);
  const PairKind kind = source.coin() ? PairKind::kVf : PairKind::kEe;
  const auto where = source.coin() ? fuzz::ContactPlace::kEdge : fuzz::ContactPlace::kInterior;
  const fuzz::ContactWeights weights = fuzz::choose_weights(source, kind, where);
  fuzz::Placement x = fuzz::choose_placement(source, 1U << 22), v = fuzz::choose_placement(source, 3);
  x.gap.setZero();
  v.span.fill(fuzz::LatticePoint::Zero());
  const fuzz::RationalTime time{source.coin() ? 1 : 0, 1};
  return to_query(kind, motion_through(place(kind, weights, x), place(kind, weights, v), time));
}

std::string judge_cull(std::uint64_t seed) {
  const fuzz::MotionQuery query = draw_contact(seed);
  const FpEnvGuard guard;
  const auto order = detail::canonical_order(query.kind, query.x_t0.data(), query.x_t1.data());
  const bool is_culled =
      detail::cull(detail::swept_corners(query.kind, order, query.x_t0.data(), query.x_t1.data()), 0);
  return is_culled ? "a contact is separated" : "";
}

std::string judge_lanes(std::uint64_t seed) {
  const fuzz::MotionQuery query = draw_contact(seed);
  testing::PairList list(query.kind);
  list.add(query.x_t0, query.x_t1);
  const Mesh mesh = list.mesh();
  const FpEnvGuard guard;
  const detail::LaneMotion motion(list.V_t0(), list.V_t1());
  const detail::LanePairs pairs =
      query.kind == PairKind::kVf ? detail::LanePairs(mesh, list.vf()) : detail::LanePairs(mesh, list.ee());
  detail::PairNumbers left;
  detail::cull_in_lanes(motion, pairs, 0, left);
  return left.count == 0 ? "a contact is separated" : "";
}

}  // namespace

std::vector<Property> cull_properties() {
  return {{"cull", "the cull separates no constructed contact (K1)", falsify<judge_cull>},
          {"lane-cull", "the cull in lanes separates no constructed contact (K1)", falsify<judge_lanes>}};
}

}  // namespace selvage::mutants
