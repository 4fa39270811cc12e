#include "cli/page/sequence_scene.h"

namespace selvage::cli {

page::Box stage_of(const io::SequenceReader& sequence, const std::vector<std::size_t>& frames) {
  page::Box cloth, all;
  for (const std::size_t i : frames) {
    const io::MeshData mesh = sequence.frame(i);
    const std::vector<std::uint8_t> is_body = io::body_faces(mesh.triangles.size(), mesh.groups);
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
      for (const std::int32_t v : mesh.triangles[f]) {
        all.add(mesh.points[static_cast<std::size_t>(v)]);
        if (is_body[f] == 0) cloth.add(mesh.points[static_cast<std::size_t>(v)]);
      }
    }
  }
  return cloth.is_empty() ? all : cloth;
}

bool add_frame(page::Scene& scene, const io::SequenceReader& sequence, bool has_times, std::size_t i,
               std::size_t byte_limit) {
  const io::MeshData mesh = sequence.frame(i);
  const std::vector<std::uint8_t> is_body = io::body_faces(mesh.triangles.size(), mesh.groups);
  const double time = has_times ? sequence.time(i) : static_cast<double>(i);
  return scene.add_frame(
      {static_cast<std::int64_t>(i), sequence.frame_name(i), time, mesh.points, mesh.triangles, is_body}, byte_limit);
}

}  // namespace selvage::cli
