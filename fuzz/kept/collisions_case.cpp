#include "fuzz/kept/collisions_case.h"

#include <algorithm>

#include "fuzz/oracle/collisions_oracle.h"

namespace selvage::fuzz {
namespace {

Retrial retry_collisions(const MeshCase& kept) { return try_collisions(kept).retrial; }

bool same_bits(const CollisionReport& a, const CollisionReport& b) {
  return a.toi_lower == b.toi_lower && std::ranges::equal(a.collisions, b.collisions, [](const auto& x, const auto& y) {
           return x.kind == y.kind && x.first == y.first && x.second == y.second && x.ccd.verdict == y.ccd.verdict &&
                  x.ccd.cause == y.ccd.cause && x.ccd.toi_lower == y.ccd.toi_lower &&
                  x.ccd.gap_bound == y.ccd.gap_bound && x.ccd.weights == y.ccd.weights && x.ccd.normal == y.ccd.normal;
         });
}

}  // namespace

const MeshKind& collisions_kind() {
  static const MeshKind kind{"collisions",
                             "the collisions of a mesh leave out no touch, are not late, and raise no alarm without "
                             "reason (K1 to K3, K6)",
                             {"at t = 0", "at t = 1"},
                             1,
                             {{"tolerance", 0, 0, kMaxCoordinate}, {"masked", 0, 0, 1, true}},
                             {{"active", 1, 0, 1, true}},
                             retry_collisions};
  return kind;
}

MeshCase collisions_case(const Mesh& mesh, const Positions& x_t0, const Positions& x_t1, double tolerance,
                         const std::vector<std::uint8_t>& active) {
  MeshCase kept;
  kept.kind = &collisions_kind();
  kept.x = {x_t0, x_t1};
  kept.settings = {tolerance, active.empty() ? 0.0 : 1.0};
  kept.marks.emplace_back(active.begin(), active.end());
  if (active.empty()) kept.marks.back().assign(kept.vertex_count(), 1);
  kept.faces = mesh.faces;
  return kept;
}

CollisionsTrial try_collisions(const MeshCase& kept) {
  CollisionsTrial trial;
  for (const Positions& x : kept.x) {
    if (!(x.cwiseAbs().maxCoeff() <= kMaxCoordinate)) {
      trial.retrial.unfit = "a vertex is outside the domain";
      return trial;
    }
  }
  const Mesh mesh = make_mesh(static_cast<std::int32_t>(kept.vertex_count()), kept.faces);
  const CcdOptions options{.tolerance = kept.setting("tolerance")};
  std::vector<std::uint8_t> active;
  if (kept.setting("masked") != 0) {
    for (const double mark : kept.marks.front()) active.push_back(mark != 0 ? 1 : 0);
  }
  BoxHierarchy hierarchy(mesh);
  const CollisionReport report = find_collisions(mesh, hierarchy, kept.x[0], kept.x[1], options, active);
  const CollisionReport visited =
      find_collisions(mesh, hierarchy, kept.x[0], kept.x[1], options, active, {.most_listed = 0});
  trial.alarms = static_cast<std::int64_t>(report.collisions.size());
  CollisionsJudgement judgement = judge(AnsweredMotion{mesh, kept.x[0], kept.x[1], options, active, report});
  trial.pairs = judgement.pairs;
  trial.retrial.failure = judgement.failure;
  trial.retrial.facts = std::move(judgement.facts);
  if (!same_bits(report, visited)) {
    trial.retrial.failure = "not-the-same";
    trial.retrial.facts.push_back("candidates that are visited lead to other answers than those that are listed");
  }
  trial.retrial.facts.push_back(std::to_string(trial.alarms) + " of " + std::to_string(trial.pairs) +
                                " pairs are not separated");
  return trial;
}

}  // namespace selvage::fuzz
