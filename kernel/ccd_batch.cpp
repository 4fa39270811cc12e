#include "kernel/ccd_batch.h"

#include <algorithm>
#include <optional>

#include "kernel/assert.h"
#include "kernel/fp_env.h"
#include "kernel/lanes/lane_cull.h"
#include "kernel/query/canonical_order.h"
#include "kernel/query/ccd_answer.h"
#include "kernel/query/ccd_detail.h"
#include "kernel/query/plane_passage.h"

namespace selvage {

namespace {

/// Preparing the lanes costs some 35 ns a vertex; a query that they spare costs 130 ns.
constexpr std::size_t kVerticesPerQuery = 2;

using Points = std::array<Vec3, 4>;
using Query = CcdResult (*)(const Points&, const Points&, const CcdOptions&);

template <typename Pair>
constexpr PairKind kKindOf = std::is_same_v<Pair, VfCandidate> ? PairKind::kVf : PairKind::kEe;

}  // namespace

struct CcdBatch::Impl {
  const Mesh& mesh;
  Positions V_t0, V_t1;  ///< a Ref of other storage would refer to its argument's temporary
  CcdOptions options;
  std::optional<detail::LaneMotion> lanes;  ///< none: every pair is asked by itself

  template <typename Pair>
  void load(const Pair& pair, Points& x_t0, Points& x_t1) const {
    const auto vertices = pair_vertices(mesh, pair);
    for (std::size_t k = 0; k < 4; ++k) {
      x_t0[k] = V_t0.row(vertices[k]);
      x_t1[k] = V_t1.row(vertices[k]);
    }
  }

  template <typename Pair>
  void search(const Pair& pair, Query query, std::size_t candidate, BatchReport& report) const {
    Points x_t0, x_t1;
    load(pair, x_t0, x_t1);
    const CcdResult result = query(x_t0, x_t1, options);
    ++report.searched;
    report.intervals += result.intervals;
    if (result.verdict != CcdVerdict::kSeparated) report.answers.push_back({candidate, result});
  }

  /// As query() ends (ccd_query.cpp).
  template <typename Pair>
  void answer(const Pair& pair, const detail::LaneContact& contact, std::size_t candidate, BatchReport& report) const {
    Points x_t0, x_t1;
    load(pair, x_t0, x_t1);
    const detail::CanonicalOrder order = detail::canonical_order(kKindOf<Pair>, x_t0.data(), x_t1.data());
    CcdResult result = detail::contact_answer(contact.passage, contact.exponent);
    result.weights = restore_weights(order, result.weights);
    result.normal = restore_normal(order, detail::to_double3(result.normal));
    report.intervals += result.intervals;
    report.answers.push_back({candidate, result});
  }

  template <typename Pair>
  [[nodiscard]] BatchReport ask(std::span<const Pair> pairs, Query query) const {
    const FpEnvGuard guard;
    BatchReport report;
    if (!lanes) {
      for (std::size_t i = 0; i < pairs.size(); ++i) search(pairs[i], query, i, report);
      return report;
    }
    detail::PairNumbers left;
    std::vector<detail::LaneContact> contacts;
    for (std::size_t first = 0; first < pairs.size(); first += detail::kPairBlock) {
      const auto block = pairs.subspan(first, std::min(detail::kPairBlock, pairs.size() - first));
      const detail::LanePairs lane_pairs(mesh, block);
      cull_in_lanes(*lanes, lane_pairs, options.tolerance, left);
      contacts.clear();
      if (lanes->is_exact()) pass_in_lanes(*lanes, lane_pairs, options.tolerance, left, contacts);
      report.intervals += static_cast<std::int64_t>(block.size() - left.count - contacts.size());
      const auto found = static_cast<std::ptrdiff_t>(report.answers.size());
      for (const detail::LaneContact& contact : contacts) {
        const bool in_limit = contact.passage.intervals <= options.max_intervals;
        if (in_limit)
          answer(block[contact.pair], contact, first + contact.pair, report);
        else
          search(block[contact.pair], query, first + contact.pair, report);
      }
      for (const std::uint32_t i : std::span(left.place).first(left.count)) search(block[i], query, first + i, report);
      std::sort(report.answers.begin() + found, report.answers.end(),
                [](const BatchAnswer& a, const BatchAnswer& b) { return a.candidate < b.candidate; });
    }
    return report;
  }
};

CcdBatch::CcdBatch(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1, const CcdOptions& options,
                   std::size_t query_count) {
  const FpEnvGuard guard;
  SELVAGE_REQUIRE(V_t0.rows() == mesh.vertex_count && V_t1.rows() == mesh.vertex_count);
  auto impl = std::make_unique<Impl>(Impl{mesh, V_t0, V_t1, options, std::nullopt});
  if (validate(options) == InputError::kNone &&
      query_count * kVerticesPerQuery >= static_cast<std::size_t>(V_t0.rows()) && query_count > 0) {
    impl->lanes.emplace(V_t0, V_t1);
    if (!impl->lanes->is_valid()) impl->lanes.reset();
  }
  impl_ = std::move(impl);
}

CcdBatch::~CcdBatch() = default;

BatchReport CcdBatch::ask(std::span<const VfCandidate> candidates) const {
  return impl_->ask(candidates, detail::vf_ccd_unguarded);
}
BatchReport CcdBatch::ask(std::span<const EeCandidate> candidates) const {
  return impl_->ask(candidates, detail::ee_ccd_unguarded);
}

}  // namespace selvage
