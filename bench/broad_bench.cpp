#include "bench/broad_bench.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/timed.h"
#include "kernel/box_hierarchy.h"
#include "kernel/fp_env.h"

namespace selvage::bench {
namespace {

constexpr std::array<std::pair<const char*, HierarchyKind>, 3> kHierarchies{{{"automatic", HierarchyKind::kAutomatic},
                                                                             {"spatial", HierarchyKind::kSpatial},
                                                                             {"topology", HierarchyKind::kTopology}}};

struct MotionBoxes {
  std::vector<Box> vertices, edges, faces;

  explicit MotionBoxes(const MeshMotion& motion) {
    for (VertexId v = 0; v < motion.mesh.vertex_count; ++v) {
      vertices.push_back(vertex_box(motion.V_t0, motion.V_t1, v, 0));
    }
    const auto united_over = [&](const auto& corners) {
      Box box;
      for (const VertexId v : corners) box.merge(vertices[static_cast<std::size_t>(v)]);
      return box;
    };
    for (const auto& edge : motion.mesh.edges) edges.push_back(united_over(edge));
    for (const auto& face : motion.mesh.faces) faces.push_back(united_over(face));
  }
  [[nodiscard]] FeatureBoxes of(const Mesh& mesh) const { return {&mesh, vertices, edges, faces}; }
};

/// Pairs of a that b has not.
template <typename Candidate>
std::int64_t difference_count(const std::vector<Candidate>& a, const std::vector<Candidate>& b) {
  std::vector<Candidate> only_a;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(only_a));
  return static_cast<std::int64_t>(only_a.size());
}

class BroadBench {
 public:
  BroadBench(const MeshMotion& motion, const BroadBenchOptions& options)
      : motion_(motion), mesh_(motion.mesh), options_(options), boxes_(motion) {
    report_.vertices = mesh_.vertex_count;
    report_.edges = static_cast<std::int64_t>(mesh_.edges.size());
    report_.faces = static_cast<std::int64_t>(mesh_.faces.size());
  }

  BroadMotionReport run(std::span<const LoadedRival> rivals) {
    BoxHierarchy warm_up(mesh_);  // the first to run would pay for fetching its memory from the system
    warm_up.refit(motion_.V_t0, motion_.V_t1, {});
    static_cast<void>(warm_up.candidates());
    for (const int thread_count : options_.thread_counts) {
      for (const auto& [name, kind] : kHierarchies) measure_hierarchy(name, kind, thread_count);
      for (const LoadedRival& rival : rivals) {
        if (rival.create) measure_rival(rival, thread_count);
      }
    }
    report_.vf = static_cast<std::int64_t>(expected_->vf.size());
    report_.ee = static_cast<std::int64_t>(expected_->ee.size());
    const BroadMethodReport& first = report_.methods.front();
    const auto face_count = static_cast<double>(report_.faces);
    report_.ns_per_work = (first.refit.cpu + first.query.cpu) /
                          (face_count * std::log2(face_count + 1) + static_cast<double>(report_.vf + report_.ee));
    compare_with_brute_force();
    if (options_.incremental) measure_incremental();
    return std::move(report_);
  }

 private:
  void measure_hierarchy(const char* name, HierarchyKind kind, int thread_count) {
    BroadMethodReport method;
    Candidates found;
    with_threads(thread_count, [&] {
      for (int pass = 0; pass < options_.repeat; ++pass) {
        std::optional<BoxHierarchy> hierarchy;
        const auto refit = [&] { hierarchy->refit(motion_.V_t0, motion_.V_t1, {}); };
        time(method.build, [&] {
          hierarchy.emplace(mesh_, kind);
          refit();  // trees by position are made here; so a refit counts as part of building for all
        });
        time(method.refit, refit);
        time(method.query, [&] { found = hierarchy->candidates(); });
      }
    });
    add(name, thread_count, method, std::move(found));
  }

  /// A rival may leave the floating-point environment of this thread changed: the guard restores it.
  void measure_rival(const LoadedRival& loaded, int thread_count) {
    BroadMethodReport method;
    Candidates found;
    with_threads(thread_count, [&] {
      const FpEnvGuard guard;
      const FeatureBoxes boxes = boxes_.of(mesh_);
      for (int pass = 0; pass < options_.repeat; ++pass) {
        const std::unique_ptr<Rival> rival = loaded.create(thread_count);
        bool refits = false;
        BestTime refit = method.refit;
        time(method.build, [&] { rival->build(boxes); });
        time(refit, [&] { refits = rival->refit(boxes); });
        if (refits) method.refit = refit;
        time(method.query, [&] { found = rival->query(); });
      }
    });
    add(loaded.name, thread_count, method, std::move(found));
  }

  /// The first method that comes, the default hierarchy on one thread, says what is expected of the others.
  void add(const std::string& name, int thread_count, BroadMethodReport method, Candidates found) {
    method.name = name;
    method.thread_count = thread_count;
    method.vf = static_cast<std::int64_t>(found.vf.size());
    method.ee = static_cast<std::int64_t>(found.ee.size());
    if (!expected_)
      expected_ = std::move(found);
    else {
      method.missing = difference_count(expected_->vf, found.vf) + difference_count(expected_->ee, found.ee);
      method.extra = difference_count(found.vf, expected_->vf) + difference_count(found.ee, expected_->ee);
    }
    report_.methods.push_back(method);
  }

  void compare_with_brute_force() {
    const auto sample = [&](std::size_t count, const auto& compare) {
      const std::size_t stride = count / static_cast<std::size_t>(options_.sampled) + 1;
      for (std::size_t i = stride / 2; i < count; i += stride, ++report_.sampled) compare(i);
    };
    sample(boxes_.vertices.size(), [&](std::size_t v) {
      std::vector<VfCandidate> pairs;
      const std::array vertex = {static_cast<VertexId>(v)};
      for (std::size_t f = 0; f < boxes_.faces.size() && mesh_.vertex_owner[v] >= 0; ++f) {
        if (overlap(boxes_.vertices[v], boxes_.faces[f]) && !share_vertex(vertex, mesh_.faces[f])) {
          pairs.push_back({vertex[0], static_cast<FaceId>(f)});
        }
      }
      const auto [begin, end] = std::equal_range(expected_->vf.begin(), expected_->vf.end(), VfCandidate{vertex[0], 0},
                                                 [](const auto& a, const auto& b) { return a.vertex < b.vertex; });
      count_differences(std::vector<VfCandidate>(begin, end), pairs);
    });
    sample(boxes_.edges.size(), [&](std::size_t a) {
      std::vector<EeCandidate> pairs;
      for (std::size_t b = a + 1; b < boxes_.edges.size(); ++b) {
        if (overlap(boxes_.edges[a], boxes_.edges[b]) && !share_vertex(mesh_.edges[a], mesh_.edges[b])) {
          pairs.push_back({static_cast<EdgeId>(a), static_cast<EdgeId>(b)});
        }
      }
      const auto [begin, end] =
          std::equal_range(expected_->ee.begin(), expected_->ee.end(), EeCandidate{static_cast<EdgeId>(a), 0},
                           [](const auto& x, const auto& y) { return x.a < y.a; });
      count_differences(std::vector<EeCandidate>(begin, end), pairs);
    });
  }
  template <typename Candidate>
  void count_differences(const std::vector<Candidate>& a, const std::vector<Candidate>& b) {
    report_.differences += difference_count(a, b) + difference_count(b, a);
  }

  void measure_incremental() {
    const std::vector<VertexId> walk = walk_over_surface();
    for (const double share : {1.0, 0.1, 0.01, 0.001, 0.0}) {
      const auto count = static_cast<std::size_t>(std::ceil(share * static_cast<double>(walk.size())));
      std::vector<std::uint8_t> patch(boxes_.vertices.size(), 0), scattered = patch;
      for (std::size_t i = 0; i < count; ++i) {
        patch[static_cast<std::size_t>(walk[i])] = 1;
        scattered[i * patch.size() / count] = 1;
      }
      measure_active("patch", patch);
      if (share > 0 && share < 1) measure_active("scattered", scattered);
    }
  }
  void measure_active(const char* spread, const std::vector<std::uint8_t>& active) {
    BroadIncrementalReport row;
    row.spread = spread;
    row.active_vertices = std::count(active.begin(), active.end(), std::uint8_t{1});
    with_threads(1, [&] {
      BoxHierarchy hierarchy(mesh_);
      hierarchy.refit(motion_.V_t0, motion_.V_t1, {});
      for (int pass = 0; pass < options_.repeat; ++pass) {
        Candidates found;
        time(row.refit, [&] { hierarchy.refit(motion_.V_t0, motion_.V_t1, {0, active}); });
        time(row.query, [&] { found = hierarchy.candidates(); });
        row.candidates = static_cast<std::int64_t>(found.vf.size() + found.ee.size());
      }
    });
    report_.incremental.push_back(row);
  }

  /// All vertices of the surface, nearest along edges to the first one first, component after component.
  [[nodiscard]] std::vector<VertexId> walk_over_surface() const {
    std::vector<std::vector<VertexId>> neighbours(boxes_.vertices.size());
    for (const auto& [a, b] : mesh_.edges) {
      neighbours[static_cast<std::size_t>(a)].push_back(b);
      neighbours[static_cast<std::size_t>(b)].push_back(a);
    }
    std::vector<VertexId> walk;
    std::vector<bool> met(boxes_.vertices.size(), false);
    const auto meet = [&](VertexId v) {
      if (met[static_cast<std::size_t>(v)]) return;
      met[static_cast<std::size_t>(v)] = true;
      walk.push_back(v);
    };
    for (std::size_t next = 0, seed = 0; seed < neighbours.size(); ++seed) {
      if (!neighbours[seed].empty()) meet(static_cast<VertexId>(seed));
      for (; next < walk.size(); ++next) {
        for (const VertexId v : neighbours[static_cast<std::size_t>(walk[next])]) meet(v);
      }
    }
    return walk;
  }

  const MeshMotion& motion_;
  const Mesh& mesh_;
  const BroadBenchOptions& options_;
  MotionBoxes boxes_;
  std::optional<Candidates> expected_;
  BroadMotionReport report_;
};

}  // namespace

BroadMotionReport run_broad_bench(const MeshMotion& motion, std::span<const LoadedRival> rivals,
                                  const BroadBenchOptions& options) {
  return BroadBench(motion, options).run(rivals);
}

bool is_wrong(const BroadMotionReport& report) {
  const auto is_ours = [](const BroadMethodReport& method) {
    return std::any_of(kHierarchies.begin(), kHierarchies.end(),
                       [&](const auto& ours) { return method.name == ours.first; });
  };
  const auto differs = [&](const BroadMethodReport& method) {
    return is_ours(method) && (method.missing > 0 || method.extra > 0);
  };
  return report.differences > 0 || std::any_of(report.methods.begin(), report.methods.end(), differs);
}

}  // namespace selvage::bench
