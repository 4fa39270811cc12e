#include "verify/frame_source.h"

#include <utility>

#include "io/file/checksum.h"
#include "verify/surface/weld.h"

namespace selvage::verify {
namespace {

template <class T>
std::uint32_t crc32_of(const std::vector<T>& values, std::uint32_t start = 0) {
  return io::crc32({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)}, start);
}

/// With its length: of lists one behind the other it is known where each ends.
template <class T>
std::uint32_t crc32_of_list(const std::vector<T>& values, std::uint32_t start) {
  const auto length = static_cast<std::uint64_t>(values.size());
  const std::uint32_t with_length = io::crc32({reinterpret_cast<const char*>(&length), sizeof length}, start);
  return values.empty() ? with_length : crc32_of(values, with_length);  // of no bytes at no address zlib's is 0
}

std::string hex(std::uint32_t value) {
  std::string text(8, '0');
  for (std::size_t i = 8; i-- > 0; value >>= 4) text[i] = "0123456789abcdef"[value & 0xf];
  return text;
}

}  // namespace

std::string sequence_identity(const io::SequenceReader& sequence) {
  const std::size_t count = sequence.frame_count();
  if (count == 0) return "0";
  const io::MeshData first = sequence.frame(0), last = sequence.frame(count - 1);
  return std::to_string(count) + "-" + hex(crc32_of(first.triangles)) + "-" + hex(crc32_of(first.points)) + "-" +
         hex(crc32_of(last.points));
}

FrameSource::FrameSource(const io::SequenceReader& sequence, const GroupRules& rules, bool weld)
    : sequence_(sequence), user_rules_(rules) {
  if (weld) weld_all();
}

void FrameSource::weld_all() {
  Weld weld;
  io::Triangles faces;
  for (std::size_t i = 0; i < sequence_.frame_count(); ++i) {
    io::MeshData mesh = sequence_.frame(i);
    if (i == 0) {
      faces = mesh.triangles;
      representatives_.resize(mesh.points.size());
    }
    if (mesh.triangles != faces || mesh.points.size() != representatives_.size()) {
      throw io::Error(io::ErrorKind::kBadInput, sequence_.frame_name(i) +
                                                    ": faces or number of vertices differ from the first frame's, so "
                                                    "vertices cannot be welded over all frames");
    }
    weld.narrow(mesh.points);
  }
  representatives_ = weld.representatives();
  for (std::size_t v = 0; v < representatives_.size(); ++v) {
    if (static_cast<std::size_t>(representatives_[v]) != v) ++welded_vertices_;
  }
}

Frame FrameSource::read(std::size_t i) {
  io::MeshData mesh = sequence_.frame(i);
  const std::string name = sequence_.frame_name(i);
  if (mesh.triangles.empty()) {
    throw io::Error(io::ErrorKind::kBadInput, name + ": no faces: there is nothing to check");
  }
  io::require_one_role(mesh.groups, name);
  std::vector<std::uint8_t> is_body = io::body_faces(mesh.triangles.size(), mesh.groups);
  ResolvedRules resolved = resolve_in(name, mesh);
  surface_changed_ = mesh.triangles != triangles_ || is_body != is_body_ || resolved != resolved_ ||
                     static_cast<std::int64_t>(mesh.points.size()) != topology_.vertex_count;
  if (surface_changed_) make_surface(mesh, std::move(is_body), std::move(resolved));
  const std::uint32_t crc32 = crc32_of(mesh.points);
  return {name, std::move(mesh.points), crc32, surface_crc32_};
}

ResolvedRules FrameSource::resolve_in(const std::string& name, const io::MeshData& mesh) const try {
  return resolve(user_rules_, mesh.groups, mesh.triangles.size());
} catch (const GroupRuleError& error) {
  throw GroupRuleError(name + ": " + error.what());
}

std::uint32_t FrameSource::crc32_of_surface() const {
  std::uint32_t crc32 = 0;
  const auto append = [&crc32](const auto& values) { crc32 = crc32_of_list(values, crc32); };
  append(std::vector<std::int64_t>{topology_.vertex_count});
  append(triangles_);
  append(is_body_);
  append(representatives_);
  append(resolved_.is_ignored);
  for (const Exemption& exemption : resolved_.exemptions) {
    append(exemption.a);
    append(exemption.b);
  }
  return crc32;
}

void FrameSource::make_surface(const io::MeshData& mesh, std::vector<std::uint8_t> is_body, ResolvedRules resolved) {
  triangles_ = mesh.triangles;
  is_body_ = std::move(is_body);
  resolved_ = std::move(resolved);
  collapsed_faces_ = 0;
  Surface surface{triangles_, is_body_, resolved_.is_ignored, resolved_.exemptions, representatives_};
  WeldedFaces welded;
  if (!representatives_.empty()) {
    welded = weld_faces(triangles_, representatives_);
    surface.triangles = welded.triangles;
    collapsed_faces_ = std::count_if(welded.collapsed.begin(), welded.collapsed.end(), [this](std::int32_t f) {
      return resolved_.is_ignored.empty() || resolved_.is_ignored[static_cast<std::size_t>(f)] == 0;
    });
  }
  topology_ = make_topology(surface, mesh.points.size());
  surface_crc32_ = crc32_of_surface();
}

}  // namespace selvage::verify
