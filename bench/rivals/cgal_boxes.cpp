// CGAL's box_intersection_d (Zomorodian and Edelsbrunner 2002): streamed segment trees over boxes in double, all at
// once. GPL: this shared object is built for the benchmark and not installed.
#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>
#include <tbb/enumerable_thread_specific.h>

#include "bench/rivals/rival.h"

namespace selvage::bench {
namespace {

using CgalBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::int32_t>;

template <typename Candidate>
using Found = tbb::enumerable_thread_specific<std::vector<Candidate>>;

template <typename Candidate>
std::vector<Candidate> joined(const Found<Candidate>& parts) {
  std::vector<Candidate> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<CgalBox> numbered(std::span<const Box> boxes) {
  std::vector<CgalBox> result;
  result.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    std::array<double, 3> lower = boxes[i].lower, upper = boxes[i].upper;
    result.emplace_back(lower.data(), upper.data(), static_cast<std::int32_t>(i));
  }
  return result;
}

class CgalBoxes : public Rival {
 public:
  explicit CgalBoxes(int thread_count) : parallel_(thread_count > 1) {}

  void build(const FeatureBoxes& boxes) override {
    mesh_ = boxes.mesh;
    vertices_ = numbered(boxes.vertices);
    std::erase_if(vertices_, [&](const CgalBox& box) { return mesh_->vertex_owner[index(box)] < 0; });
    edges_ = numbered(boxes.edges);
    faces_ = numbered(boxes.faces);
  }
  bool refit(const FeatureBoxes& boxes) override {
    build(boxes);
    return false;
  }
  Candidates query() override { return parallel_ ? find<CGAL::Parallel_tag>() : find<CGAL::Sequential_tag>(); }

 private:
  static std::size_t index(const CgalBox& box) { return static_cast<std::size_t>(box.info()); }

  template <typename Concurrency>
  Candidates find() {
    Found<VfCandidate> vf;
    Found<EeCandidate> ee;
    const auto add_vf = [&](const CgalBox& vertex, const CgalBox& face) {
      if (!share_vertex(std::array{vertex.info()}, mesh_->faces[index(face)])) {
        vf.local().push_back({vertex.info(), face.info()});
      }
    };
    const auto add_ee = [&](const CgalBox& a, const CgalBox& b) {
      if (share_vertex(mesh_->edges[index(a)], mesh_->edges[index(b)])) return;
      ee.local().push_back({std::min(a.info(), b.info()), std::max(a.info(), b.info())});
    };
    CGAL::box_intersection_d<Concurrency>(vertices_.begin(), vertices_.end(), faces_.begin(), faces_.end(), add_vf);
    CGAL::box_self_intersection_d<Concurrency>(edges_.begin(), edges_.end(), add_ee);
    return {joined(vf), joined(ee)};
  }

  bool parallel_;
  const Mesh* mesh_ = nullptr;
  std::vector<CgalBox> vertices_, edges_, faces_;
};

}  // namespace
}  // namespace selvage::bench

extern "C" __attribute__((visibility("default"))) selvage::bench::Rival* selvage_make_rival(int thread_count) {
  return new selvage::bench::CgalBoxes(thread_count);
}
