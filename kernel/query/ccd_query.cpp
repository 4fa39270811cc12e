// One query from the caller's points to the caller's labels: domain, canonical order, cull, search.
#include "kernel/query/canonical_order.h"
#include "kernel/query/ccd_detail.h"
#include "kernel/query/ccd_search.h"
#include "kernel/query/cull.h"

namespace selvage::detail {

namespace {

PairPoints ordered(const CanonicalOrder& order, const Vec3* x, std::size_t count) {
  PairPoints points;
  for (std::size_t i = 0; i < count; ++i) points[i] = to_double3(x[order.original[i]]);
  return points;
}

CcdResult query(PairKind kind, const Vec3* x_t0, const Vec3* x_t1, const CcdOptions& options) {
  const std::size_t count = kind == PairKind::kSelf ? 3 : 4;
  if (validate(options) != InputError::kNone || !in_domain({x_t0, count}) || !in_domain({x_t1, count})) return {};
  const CanonicalOrder order = canonical_order(kind, x_t0, x_t1);
  if (cull(swept_corners(kind, order, x_t0, x_t1), options.tolerance)) {
    CcdResult result;
    result.verdict = CcdVerdict::kSeparated;
    result.cause = CcdCause::kNone;
    result.toi_lower = 1;
    result.intervals = 1;
    return result;
  }
  CcdResult result = search_in_time(kind, ordered(order, x_t0, count), ordered(order, x_t1, count), options);
  result.weights = restore_weights(order, result.weights);
  result.normal = restore_normal(order, to_double3(result.normal));
  return result;
}

}  // namespace

CcdResult vf_ccd_unguarded(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                           const CcdOptions& options) {
  return query(PairKind::kVf, x_t0.data(), x_t1.data(), options);
}

CcdResult ee_ccd_unguarded(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                           const CcdOptions& options) {
  return query(PairKind::kEe, x_t0.data(), x_t1.data(), options);
}

CcdResult self_ccd_unguarded(const std::array<Vec3, 3>& x_t0, const std::array<Vec3, 3>& x_t1,
                             const CcdOptions& options) {
  return query(PairKind::kSelf, x_t0.data(), x_t1.data(), options);
}

}  // namespace selvage::detail
