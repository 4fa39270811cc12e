#include "cli/arguments/hidden_groups.h"

#include <algorithm>
#include <utility>

#include "cli/arguments/group_names.h"
#include "cli/arguments/sequence_decorator.h"
#include "cli/process/exit_code.h"

namespace selvage::cli {
namespace {

/// Also of vertices that no face had before: they are not drawn.
void drop_vertices_of_no_face(io::MeshData& mesh) {
  std::vector<std::int32_t> number(mesh.points.size(), -1);  // of those that stay, among them
  for (const auto& triangle : mesh.triangles) {
    for (const std::int32_t vertex : triangle) number[static_cast<std::size_t>(vertex)] = 0;
  }
  io::Points points;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<std::int32_t>(points.size());
    points.push_back(mesh.points[v]);
  }
  mesh.points = std::move(points);
  for (auto& triangle : mesh.triangles) {
    for (std::int32_t& vertex : triangle) vertex = number[static_cast<std::size_t>(vertex)];
  }
}

class HiddenGroups final : public SequenceDecorator {
 public:
  HiddenGroups(std::unique_ptr<io::SequenceReader> sequence, const std::vector<std::string>& names)
      : SequenceDecorator(std::move(sequence)), names_(names) {
    require_known("--hide", names, inner().groups());
    const io::MeshData first = frame(0);
    if (first.triangles.empty()) throw UsageError("--hide: these groups hold all faces; there is nothing left to show");
    groups_ = first.groups;
  }

  const std::vector<io::Group>& groups() const override { return groups_; }
  io::MeshData frame(std::size_t frame) const override {
    io::MeshData mesh = SequenceDecorator::frame(frame);
    std::vector<std::uint8_t> is_hidden(mesh.triangles.size(), 0);
    for (const io::Group& group : mesh.groups) {
      if (std::ranges::find(names_, group.name) == names_.end()) continue;
      std::fill(is_hidden.begin() + group.face_begin, is_hidden.begin() + group.face_end, std::uint8_t{1});
    }
    io::Triangles kept;
    std::vector<std::int32_t> kept_before = {0};
    for (std::size_t f = 0; f < is_hidden.size(); ++f) {
      if (is_hidden[f] == 0) kept.push_back(mesh.triangles[f]);
      kept_before.push_back(static_cast<std::int32_t>(kept.size()));
    }
    mesh.triangles = std::move(kept);
    for (io::Group& group : mesh.groups) {
      group.face_begin = kept_before[static_cast<std::size_t>(group.face_begin)];
      group.face_end = kept_before[static_cast<std::size_t>(group.face_end)];
    }
    drop_vertices_of_no_face(mesh);
    return mesh;
  }

 private:
  std::vector<std::string> names_;
  std::vector<io::Group> groups_;
};

}  // namespace

void add_hide(CLI::App& command, std::vector<std::string>& names) {
  command.add_option("--hide", names, "Leave this group out, as a body that hides the cloth; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
}

std::unique_ptr<io::SequenceReader> without_groups(std::unique_ptr<io::SequenceReader> sequence,
                                                   const std::vector<std::string>& names) {
  if (names.empty()) return sequence;
  return std::make_unique<HiddenGroups>(std::move(sequence), names);
}

}  // namespace selvage::cli
