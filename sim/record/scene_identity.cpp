#include "sim/record/scene_identity.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/file/atomic_file.h"
#include "sim/base/fnv1a.h"
#include "sim/base/points.h"
#include "sim/record/changed_setting.h"

namespace selvage::sim {
namespace {

std::uint64_t digest_of_part(const World& world, std::size_t part) {
  std::uint64_t hash = fnv1a({});
  const io::Group& group = world.groups[part];
  for (auto f = static_cast<std::size_t>(group.face_begin); f < static_cast<std::size_t>(group.face_end); ++f) {
    const auto& face = world.triangles[f];
    for (const VertexId vertex : face) {
      // From the part's first corner: what is before it may have grown.
      const VertexId number = vertex - world.triangles[static_cast<std::size_t>(group.face_begin)][0];
      hash = fnv1a({reinterpret_cast<const char*>(&number), sizeof number}, hash);
      const Eigen::RowVector3d x = world.x_t0.row(vertex);
      hash = fnv1a({reinterpret_cast<const char*>(x.data()), 3 * sizeof(double)}, hash);
    }
  }
  // The bodies are the last groups and the first colliders, in one order.
  const std::size_t first_body = world.groups.size() - static_cast<std::size_t>(world.body_count);
  if (part < first_body) return hash;
  const BodySequence* sequence = world.colliders[part - first_body].sequence();
  return sequence == nullptr ? hash : fnv1a(std::to_string(sequence->checksum()), hash);
}

const char* name_of(Quality quality) { return quality == Quality::kDraft ? "draft" : "full"; }

}  // namespace

SceneIdentity identify(const Scene& scene, const World& world) {
  SceneIdentity identity{io::read_file(scene.file), scene.quality, {}, 0};
  for (std::size_t part = 0; part < world.groups.size(); ++part) {
    identity.parts.push_back(digest_of_part(world, part));
  }
  identity.whole = fnv1a(
      {reinterpret_cast<const char*>(world.triangles.data()), world.triangles.size() * sizeof(world.triangles[0])});
  identity.whole = fnv1a(bytes_of(world.v_t0), fnv1a(bytes_of(world.x_t0), identity.whole));
  return identity;
}

std::uint64_t fingerprint_of(const SceneIdentity& identity) {
  std::uint64_t hash = fnv1a(name_of(identity.quality), fnv1a(identity.text));
  for (const std::uint64_t part : identity.parts) {
    hash = fnv1a({reinterpret_cast<const char*>(&part), sizeof part}, hash);
  }
  return fnv1a({reinterpret_cast<const char*>(&identity.whole), sizeof identity.whole}, hash);
}

std::optional<std::string> first_difference(const SceneIdentity& before, const SceneIdentity& now, const World& world) {
  if (auto changed = changed_setting(before.text, now.text)) return changed;
  if (before.quality != now.quality) {
    return fmt::format("--quality was {} and is {}", name_of(before.quality), name_of(now.quality));
  }
  for (std::size_t part = 0; part < std::min(before.parts.size(), now.parts.size()); ++part) {
    if (before.parts[part] != now.parts[part]) {
      return fmt::format("the file of \"{}\" is not what it was, or is read otherwise by this version",
                         world.groups[part].name);
    }
  }
  if (before.parts == now.parts && before.whole == now.whole) return std::nullopt;
  return "one of the mesh files is not what it was";
}

}  // namespace selvage::sim
