#include "bench/ccd_methods.h"

#include "bench/textbook.h"
#include "kernel/ccd_batch.h"
#include "verify/decision/exact_motion.h"

namespace selvage::bench {
namespace {

struct KernelQuery {
  std::array<Vec3, 4> x_t0, x_t1;
};
KernelQuery kernel_query(const MeshMotion& motion, const std::array<VertexId, 4>& vertices) {
  KernelQuery query;
  for (std::size_t i = 0; i < 4; ++i) {
    query.x_t0[i] = motion.V_t0.row(vertices[i]);
    query.x_t1[i] = motion.V_t1.row(vertices[i]);
  }
  return query;
}

/// One after another; `ask` returns whether the pair is an alarm, and fills it in.
template <typename Pairs, typename Ask>
CcdAnswers one_by_one(const MeshMotion& motion, const Pairs& pairs, const Ask& ask) {
  CcdAnswers answers;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    Alarm alarm{i, 0, 0, false};
    if (ask(pair_vertices(motion.mesh, pairs[i]), alarm)) answers.alarms.push_back(alarm);
  }
  return answers;
}

using CcdQuery = CcdResult (*)(const std::array<Vec3, 4>&, const std::array<Vec3, 4>&, const CcdOptions&);
using TextbookQuery = TextbookAnswer (*)(const std::array<Vec3, 4>&, const std::array<Vec3, 4>&, double);
using ExactDecision = verify::MotionAnswer (*)(const std::array<verify::Point, 4>&, const std::array<verify::Point, 4>&,
                                               verify::Detail);

template <typename Pairs>
CcdAnswers ask_scalar(const MeshMotion& motion, const Pairs& pairs, const CcdOptions& options, CcdQuery ccd) {
  return one_by_one(motion, pairs, [&](const std::array<VertexId, 4>& vertices, Alarm& alarm) {
    const KernelQuery query = kernel_query(motion, vertices);
    const CcdResult result = ccd(query.x_t0, query.x_t1, options);
    if (result.verdict == CcdVerdict::kSeparated) return false;
    alarm.toi = result.toi_lower;
    alarm.gap_bound = result.gap_bound;
    alarm.unresolved = result.verdict == CcdVerdict::kUnresolved;
    return true;
  });
}

template <typename Pairs>
CcdAnswers ask_textbook(const MeshMotion& motion, const Pairs& pairs, TextbookQuery textbook) {
  return one_by_one(motion, pairs, [&](const std::array<VertexId, 4>& vertices, Alarm& alarm) {
    const KernelQuery query = kernel_query(motion, vertices);
    const TextbookAnswer answer = textbook(query.x_t0, query.x_t1, kTextbookTolerance);
    alarm.toi = answer.toi;
    return answer.collides;
  });
}

/// The same as the checker takes it.
struct ExactQuery {
  std::array<verify::Point, 4> x_t0, x_t1;
};
ExactQuery exact_query(const MeshMotion& motion, const std::array<VertexId, 4>& vertices) {
  ExactQuery query;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      query.x_t0[i][k] = motion.V_t0(vertices[i], static_cast<Eigen::Index>(k));
      query.x_t1[i][k] = motion.V_t1(vertices[i], static_cast<Eigen::Index>(k));
    }
  }
  return query;
}

template <typename Pairs>
CcdAnswers ask_exact(const MeshMotion& motion, const Pairs& pairs, ExactDecision decide) {
  return one_by_one(motion, pairs, [&](const std::array<VertexId, 4>& vertices, Alarm&) {
    const ExactQuery query = exact_query(motion, vertices);
    return decide(query.x_t0, query.x_t1, verify::Detail::kDecision).touches;
  });
}

CcdAnswers kernel(PairKind kind, const MeshMotion& motion, const Candidates& candidates, const CcdOptions& options) {
  const std::size_t count = kind == PairKind::kVf ? candidates.vf.size() : candidates.ee.size();
  const CcdBatch batch(motion.mesh, motion.V_t0, motion.V_t1, options, count);
  const BatchReport report = kind == PairKind::kVf ? batch.ask(candidates.vf) : batch.ask(candidates.ee);
  CcdAnswers answers;
  answers.searched = report.searched;
  answers.alarms.reserve(report.answers.size());
  for (const BatchAnswer& answer : report.answers) {
    answers.alarms.push_back(
        {answer.candidate, answer.ccd.toi_lower, answer.ccd.gap_bound, answer.ccd.verdict == CcdVerdict::kUnresolved});
  }
  return answers;
}
CcdAnswers kernel_scalar(PairKind kind, const MeshMotion& motion, const Candidates& candidates,
                         const CcdOptions& options) {
  return kind == PairKind::kVf ? ask_scalar(motion, candidates.vf, options, vf_ccd)
                               : ask_scalar(motion, candidates.ee, options, ee_ccd);
}
CcdAnswers textbook(PairKind kind, const MeshMotion& motion, const Candidates& candidates, const CcdOptions&) {
  return kind == PairKind::kVf ? ask_textbook(motion, candidates.vf, textbook_vf)
                               : ask_textbook(motion, candidates.ee, textbook_ee);
}
CcdAnswers exact(PairKind kind, const MeshMotion& motion, const Candidates& candidates, const CcdOptions&) {
  return kind == PairKind::kVf ? ask_exact(motion, candidates.vf, verify::exact_vf_motion)
                               : ask_exact(motion, candidates.ee, verify::exact_ee_motion);
}

constexpr std::array<CcdMethod, 4> kCcdMethods{{{"kernel", kernel, true, true},
                                                {"kernel_scalar", kernel_scalar, true, true},
                                                {"textbook", textbook, true, false},
                                                {"exact", exact, false, false}}};

}  // namespace

std::span<const CcdMethod> ccd_methods() { return kCcdMethods; }

MethodQuery query_of(PairKind kind, const MeshMotion& motion, const Candidates& candidates, std::size_t pair) {
  const KernelQuery query =
      kernel_query(motion, kind == PairKind::kVf ? pair_vertices(motion.mesh, candidates.vf[pair])
                                                 : pair_vertices(motion.mesh, candidates.ee[pair]));
  return method_query(kind, query.x_t0, query.x_t1);
}

}  // namespace selvage::bench
