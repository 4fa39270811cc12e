// CGAL's Polygon_mesh_processing::self_intersections on a Surface_mesh, with exact predicates. GPL: this shared object
// is built for the benchmark and not installed.
#include <stdexcept>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include "bench/rivals/frame_rival.h"

namespace selvage::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using FacePair = std::pair<Mesh::Face_index, Mesh::Face_index>;

class CgalFaces : public FrameRival {
 public:
  void build(std::span<const std::array<std::int32_t, 3>> triangles,
             std::span<const std::array<double, 3>> points) override {
    mesh_.reserve(static_cast<unsigned>(points.size()), static_cast<unsigned>(3 * triangles.size() / 2),
                  static_cast<unsigned>(triangles.size()));
    for (const auto& p : points) mesh_.add_vertex({p[0], p[1], p[2]});
    const auto vertex = [](std::int32_t v) { return Mesh::Vertex_index(static_cast<unsigned>(v)); };
    for (const auto& [a, b, c] : triangles) {
      if (mesh_.add_face(vertex(a), vertex(b), vertex(c)) == Mesh::null_face()) {
        throw std::invalid_argument("CGAL takes this mesh for no manifold");
      }
    }
  }

  std::vector<std::array<std::int32_t, 2>> intersections(bool in_parallel) override {
    std::vector<FacePair> found;
    if (in_parallel) {
      CGAL::Polygon_mesh_processing::self_intersections<CGAL::Parallel_tag>(mesh_, std::back_inserter(found));
    } else {
      CGAL::Polygon_mesh_processing::self_intersections<CGAL::Sequential_tag>(mesh_, std::back_inserter(found));
    }
    std::vector<std::array<std::int32_t, 2>> pairs;
    for (const auto& [f, g] : found) {
      pairs.push_back(
          {static_cast<std::int32_t>(std::min(f, g).idx()), static_cast<std::int32_t>(std::max(f, g).idx())});
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }

 private:
  Mesh mesh_;
};

}  // namespace
}  // namespace selvage::bench

extern "C" __attribute__((visibility("default"))) selvage::bench::FrameRival* selvage_make_frame_rival() {
  return new selvage::bench::CgalFaces;
}
