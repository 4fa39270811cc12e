#include "fuzz/kept/broad_case.h"

#include <algorithm>
#include <array>

#include "kernel/box_hierarchy.h"

namespace selvage::fuzz {
namespace {

struct HierarchyName {
  HierarchyKind kind;
  const char* name;
};
constexpr std::array<HierarchyName, 3> kHierarchies{{{HierarchyKind::kAutomatic, "automatic"},
                                                     {HierarchyKind::kSpatial, "spatial"},
                                                     {HierarchyKind::kTopology, "topology"}}};

Retrial retry_broad(const MeshCase& kept) { return try_broad(kept).retrial; }

BroadQuestion question_of(const MeshCase& kept, std::size_t motion) {
  BroadQuestion question{kept.settings[2 * motion], {}};
  if (kept.settings[2 * motion + 1] == 0) return question;
  for (const double active : kept.marks[motion]) question.active.push_back(active != 0 ? 1 : 0);
  return question;
}

/// The first pair that only one of the sorted lists has, in words, or nothing.
template <typename Pair, typename Words>
std::string difference(const std::vector<Pair>& expected, const std::vector<Pair>& found, const Words& words) {
  const auto [e, f] = std::ranges::mismatch(expected, found);
  if (e == expected.end() && f == found.end()) return {};
  const bool is_missing = f == found.end() || (e != expected.end() && *e < *f);
  return (is_missing ? "misses " : "adds ") + words(is_missing ? *e : *f);
}

std::string difference(const Mesh& mesh, const Candidates& expected, const Candidates& found) {
  std::string vf = difference(expected.vf, found.vf, [](const VfCandidate& pair) {
    return "vertex " + std::to_string(pair.vertex) + " and face " + std::to_string(pair.face);
  });
  if (!vf.empty()) return vf;
  return difference(expected.ee, found.ee, [&](const EeCandidate& pair) {
    const auto &a = mesh.edges[static_cast<std::size_t>(pair.a)], &b = mesh.edges[static_cast<std::size_t>(pair.b)];
    return "edges " + std::to_string(a[0]) + " " + std::to_string(a[1]) + " and " + std::to_string(b[0]) + " " +
           std::to_string(b[1]);
  });
}

}  // namespace

const MeshKind& broad_kind() {
  static const MeshKind kind{"broad",
                             "every hierarchy finds exactly the pairs that brute force finds (K6)",
                             {"x", "after one motion", "after two"},
                             2,
                             {{"reach_1", 0, 0, kMaxCoordinate},
                              {"masked_1", 0, 0, 1, true},
                              {"reach_2", 0, 0, kMaxCoordinate},
                              {"masked_2", 0, 0, 1, true}},
                             {{"active_1", 1, 0, 1, true}, {"active_2", 1, 0, 1, true}},
                             retry_broad};
  return kind;
}

MeshCase broad_case(const Mesh& mesh, const std::array<Positions, 3>& x,
                    const std::array<BroadQuestion, 2>& questions) {
  MeshCase kept;
  kept.kind = &broad_kind();
  kept.x.assign(x.begin(), x.end());
  for (const BroadQuestion& question : questions) {
    kept.settings.push_back(question.reach);
    kept.settings.push_back(question.active.empty() ? 0 : 1);
    kept.marks.emplace_back(question.active.begin(), question.active.end());
    if (question.active.empty()) kept.marks.back().assign(kept.vertex_count(), 1);
  }
  kept.faces = mesh.faces;
  return kept;
}

BroadTrial try_broad(const MeshCase& kept) {
  BroadTrial trial;
  for (const Positions& x : kept.x) {
    if (!(x.cwiseAbs().maxCoeff() <= kMaxCoordinate)) {
      trial.retrial.unfit = "a vertex is outside the domain";
      return trial;
    }
  }
  const Mesh mesh = make_mesh(static_cast<std::int32_t>(kept.vertex_count()), kept.faces);
  std::vector<BoxHierarchy> hierarchies;
  hierarchies.reserve(std::size(kHierarchies));
  for (const HierarchyName& one : kHierarchies) hierarchies.emplace_back(mesh, one.kind);
  for (std::size_t motion = 0; motion < 2; ++motion) {
    const BroadQuestion question = question_of(kept, motion);
    for (const MotionBoxes boxes : {MotionBoxes::kSwept, MotionBoxes::kMoving}) {
      const CandidateOptions options{question.reach, question.active, boxes};
      const Candidates all = find_candidates_brute_force(mesh, kept.x[motion], kept.x[motion + 1], options);
      if (boxes == MotionBoxes::kSwept) trial.pairs += static_cast<std::int64_t>(all.vf.size() + all.ee.size());
      for (std::size_t i = 0; i < hierarchies.size(); ++i) {
        hierarchies[i].refit(kept.x[motion], kept.x[motion + 1], options);
        const std::string off = difference(mesh, all, hierarchies[i].candidates());
        if (off.empty()) continue;
        trial.retrial.failure = "not-brute-force";
        trial.retrial.facts.push_back("in motion " + std::to_string(motion + 1) + " the " + kHierarchies[i].name +
                                      " hierarchy" + (boxes == MotionBoxes::kMoving ? " with moving boxes " : " ") +
                                      off);
      }
    }
  }
  trial.retrial.facts.push_back("brute force finds " + std::to_string(trial.pairs) + " pairs in two motions");
  return trial;
}

}  // namespace selvage::fuzz
