#include "bench/micro/workloads.h"

#include "bench/method_bench.h"
#include "kernel/box_hierarchy.h"
#include "kernel/ccd_batch.h"

namespace selvage::bench {
namespace {

constexpr CcdOptions kOptions{.tolerance = 0};

}  // namespace

SheetWork sheet_work(int side) {
  SheetWork work{crumpled_sheet(side), {}, {}};
  work.candidates = candidates_of(work.motion, 0);
  const std::size_t all = work.candidates.vf.size() + work.candidates.ee.size();
  work.queries = candidate_set("sheet", work.motion, all).queries;
  return work;
}

std::int64_t ask_single(const SheetWork& work) {
  std::int64_t intervals = 0;
  for (const MethodQuery& query : work.queries) {
    intervals += (query.kind == PairKind::kVf ? vf_ccd : ee_ccd)(query.x_t0, query.x_t1, kOptions).intervals;
  }
  return intervals;
}

std::int64_t ask_in_batches(const SheetWork& work) {
  const MeshMotion& motion = work.motion;
  const CcdBatch batch(motion.mesh, motion.V_t0, motion.V_t1, kOptions, work.queries.size());
  return batch.ask(work.candidates.vf).intervals + batch.ask(work.candidates.ee).intervals;
}

std::int64_t find_candidates(const SheetWork& work) {
  const Candidates found = candidates_of(work.motion, 0);
  return static_cast<std::int64_t>(found.vf.size() + found.ee.size());
}

std::int64_t decide_exactly(const SheetWork& work) {
  std::int64_t touching = 0;
  for (const MethodQuery& query : work.queries) touching += exact_answer(query, verify::Detail::kDecision).touches;
  return touching;
}

}  // namespace selvage::bench
