#include "fuzz/oracle/collisions_oracle.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "fuzz/oracle/query_oracle.h"

namespace selvage::fuzz {
namespace {

/// What is said of a pair that the report does not name.
CcdResult left_out() {
  CcdResult result;
  result.verdict = CcdVerdict::kSeparated;
  result.cause = CcdCause::kNone;
  result.toi_lower = 1;
  return result;
}

/// Calls visit(kind, first, second) for every pair of the mesh, in the order of a report.
template <typename Visit>
void for_each_pair(const Mesh& mesh, const Visit& visit) {
  const auto holds = [](const auto& feature, VertexId v) { return std::ranges::find(feature, v) != feature.end(); };
  for (const PairKind kind : {PairKind::kVf, PairKind::kEe, PairKind::kSelf}) {
    if (kind == PairKind::kEe) {
      for (EdgeId a = 0; a < std::ssize(mesh.edges); ++a) {
        for (EdgeId b = a + 1; b < std::ssize(mesh.edges); ++b) {
          const auto &p = mesh.edges[static_cast<std::size_t>(a)], &q = mesh.edges[static_cast<std::size_t>(b)];
          if (!holds(p, q[0]) && !holds(p, q[1])) visit(kind, a, b);
        }
      }
      continue;
    }
    for (VertexId v = 0; v < mesh.vertex_count; ++v) {
      if (mesh.vertex_owner[static_cast<std::size_t>(v)] < 0) continue;  // of no face
      for (FaceId f = 0; f < std::ssize(mesh.faces); ++f) {
        if (holds(mesh.faces[static_cast<std::size_t>(f)], v) == (kind == PairKind::kSelf)) visit(kind, v, f);
      }
    }
  }
}

}  // namespace

CollisionsJudgement judge(const AnsweredMotion& motion) {
  constexpr std::size_t kToldPairs = 4;
  // A mesh at one point raises 10^5 alarms, and an alarm takes a fifth of a millisecond to judge, one between exponents
  // a thousand apart five times that.
  constexpr std::int64_t kJudgedAlarms = 500;
  CollisionsJudgement judgement;
  const auto fail = [&](std::string_view failure, std::string fact) {
    if (judgement.failure.empty()) judgement.failure = failure;
    if (judgement.facts.size() < kToldPairs) judgement.facts.push_back(std::move(fact));
  };
  auto next = motion.report.collisions.begin();
  for_each_pair(motion.mesh, [&](PairKind kind, std::int32_t first, std::int32_t second) {
    const std::array<VertexId, 4> vertices = pair_vertices(motion.mesh, kind, first, second);
    const bool is_asked = motion.active.empty() || std::ranges::any_of(vertices, [&](VertexId v) {
                            return motion.active[static_cast<std::size_t>(v)] != 0;
                          });
    const bool is_answered = next != motion.report.collisions.end() &&
                             std::tie(next->kind, next->first, next->second) == std::tie(kind, first, second);
    if (!is_asked && !is_answered) return;
    const auto fail_pair = [&](std::string_view failure, const char* how) {
      fail(failure, how + std::string(name_of(kind)) + " " + std::to_string(first) + " " + std::to_string(second));
    };
    if (!is_asked) fail_pair("not-asked", "without an active vertex: ");
    const CcdResult answer = is_answered ? (next++)->ccd : left_out();
    if (answer.toi_lower < motion.report.toi_lower) fail_pair("late-toi", "before the toi_lower of all: ");
    if (is_answered && next - motion.report.collisions.begin() > kJudgedAlarms) return;
    MotionQuery query{kind, {}, {}, motion.options};
    for (std::size_t i = 0; i < 4; ++i) {
      query.x_t0[i] = motion.x_t0.row(vertices[i]);
      query.x_t1[i] = motion.x_t1.row(vertices[i]);
    }
    ++judgement.pairs;
    const Disagreement disagreement = judge(query, answer).disagreement;
    if (disagreement != Disagreement::kNone)
      fail_pair(name_of(disagreement), is_answered ? "answered: " : "left out: ");
  });
  if (next != motion.report.collisions.end())
    fail("malformed", "what is answered is no pair of the mesh, or out of order");
  return judgement;
}

}  // namespace selvage::fuzz
