// The frames of a sequence as the checks see them: with the user's rules applied, welded, and a topology that is made
// anew only where faces or groups change.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/sequence.h"
#include "verify/check.h"
#include "verify/surface/group_rules.h"
#include "verify/surface/topology.h"

namespace selvage::verify {

struct Frame {
  std::string name;
  io::Points points;
  std::uint32_t crc32 = 0;  ///< of the positions as doubles
  /// Of all else that its results depend on: the number of vertices, faces, which belong to bodies, what the rules say
  /// of them, what is welded.
  std::uint32_t surface_crc32 = 0;
};

class FrameSource {
 public:
  /// With `weld` reads all frames: throws io::Error where their faces or number of vertices differ.
  FrameSource(const io::SequenceReader& sequence, const GroupRules& rules, bool weld);

  /// Throws io::Error, and GroupRuleError where the rules do not fit the frame's groups.
  [[nodiscard]] Frame read(std::size_t frame);

  // Of the frame read last:
  [[nodiscard]] const Topology& topology() const { return topology_; }
  /// What its surface_crc32 is of differs from that of the frame read before.
  [[nodiscard]] bool surface_changed() const { return surface_changed_; }
  [[nodiscard]] const ResolvedRules& rules() const { return resolved_; }
  /// Faces that lost a corner to welding and are not ignored.
  [[nodiscard]] std::int64_t collapsed_faces() const { return collapsed_faces_; }
  [[nodiscard]] std::int64_t face_count() const { return static_cast<std::int64_t>(triangles_.size()); }
  /// Of all frames: vertices that were joined to another.
  [[nodiscard]] std::int64_t welded_vertices() const { return welded_vertices_; }

 private:
  ResolvedRules resolve_in(const std::string& name, const io::MeshData& mesh) const;
  void weld_all();
  [[nodiscard]] std::uint32_t crc32_of_surface() const;
  void make_surface(const io::MeshData& mesh, std::vector<std::uint8_t> is_body, ResolvedRules resolved);

  const io::SequenceReader& sequence_;
  const GroupRules& user_rules_;
  std::vector<std::int32_t> representatives_;  // empty: not welded
  std::int64_t welded_vertices_ = 0;
  io::Triangles triangles_;  // as read
  std::vector<std::uint8_t> is_body_;
  ResolvedRules resolved_;
  Topology topology_;
  std::uint32_t surface_crc32_ = 0;
  std::int64_t collapsed_faces_ = 0;
  bool surface_changed_ = false;
};

}  // namespace selvage::verify
