// The two public pairs of frames with published candidate counts (Sample-Scalable-CCD-Data).
#pragma once

#include <optional>
#include <string>

#include "io/mesh_reader.h"
#include "kernel/mesh.h"
#include "tests/public_data.h"

namespace selvage::testing {

struct PublicFrames {
  Mesh mesh;
  Positions V_t0, V_t1;
};

/// `scene`/frames/`frame_t0` and `frame_t1` of the public data, or nothing where they are absent.
inline std::optional<PublicFrames> public_frames(const std::string& scene, const std::string& frame_t0,
                                                 const std::string& frame_t1) {
  const auto data = public_data();
  if (!data) return std::nullopt;
  const auto folder = *data / "ccd" / "scalable-ccd" / scene / "frames";
  if (!std::filesystem::exists(folder / frame_t0) || !std::filesystem::exists(folder / frame_t1)) return std::nullopt;
  const io::MeshData t0 = io::read_mesh(folder / frame_t0), t1 = io::read_mesh(folder / frame_t1);
  const auto positions = [](const io::MeshData& frame) {
    return Positions(
        Eigen::Map<const Positions>(frame.points.front().data(), static_cast<Eigen::Index>(frame.points.size()), 3));
  };
  const Eigen::Map<const Faces> F(t0.triangles.front().data(), static_cast<Eigen::Index>(t0.triangles.size()), 3);
  return PublicFrames{make_mesh(static_cast<VertexId>(t0.points.size()), F), positions(t0), positions(t1)};
}

}  // namespace selvage::testing
