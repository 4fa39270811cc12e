// Writes OBJ: one file a frame, each number in the shortest form that is read as the same double.
#include <algorithm>
#include <charconv>
#include <utility>

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/fp_guard.h"
#include "io/file/text.h"
#include "io/sequence/sequence_outputs.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLongestNumber = 24;  // "-2.2250738585072014e-308"

template <typename Number>
void append_number(std::string& text, Number value) {
  char digits[kLongestNumber];
  text += ' ';
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// A group's name is the rest of its line: what a reader strips or takes for the end of the line would not come back,
/// and behind a backslash many go on with the next line.
void require_readable(const std::string& group, const std::string& name) {
  const bool is_plain = std::none_of(group.begin(), group.end(), [](char c) { return (c & 0x7f) == c && c < ' '; });
  if (is_plain && trimmed(group) == group && !group.ends_with('\\') && is_utf8(group)) return;
  bad_input(name, "the name of the group " + in_quotes(group) + " does not fit into a line of OBJ; rename it");
}

/// "default", or "default_2", ... where groups have the names before it.
std::string free_name(const std::vector<Group>& groups) {
  std::string name = "default";
  for (int number = 2; std::ranges::find(groups, name, &Group::name) != groups.end(); ++number) {
    name = "default_" + std::to_string(number);
  }
  return name;
}

/// The groups in the order of their faces, and one of a name of its own for faces between them that are in none: OBJ
/// cannot end a group but by starting another.
std::vector<Group> cover(std::vector<Group> groups, std::size_t face_count, const std::string& name) {
  std::erase_if(groups, [](const Group& group) { return group.face_begin == group.face_end; });
  std::sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.face_begin < b.face_begin; });
  const std::string none = free_name(groups);
  std::vector<Group> covering;
  std::int32_t covered = 0;
  const auto fill_to = [&](std::int32_t face) {
    if (covered < face) covering.push_back({.name = none, .face_begin = covered, .face_end = face});
  };
  for (Group& group : groups) {
    if (group.face_begin < covered) bad_input(name, "two groups share a face, which OBJ cannot say; separate them");
    require_readable(group.name, name);
    fill_to(group.face_begin);
    covered = group.face_end;
    covering.push_back(std::move(group));
  }
  if (!covering.empty()) fill_to(static_cast<std::int32_t>(face_count));
  return covering;
}

class ObjOutput final : public SequenceOutput {
 public:
  ObjOutput(fs::path file, OutputHeader all) : SequenceOutput(std::move(file), std::move(all)) {
    for (std::size_t i = 0; i < header().frame_count; ++i) require_absent(path_of(i));
  }
  std::vector<fs::path> sources() const override { return sources_; }

 private:
  void write_frame(double, const MeshData& mesh) override {
    const fs::path file = path_of(frame_count());
    written_.write(file, obj_bytes(mesh, file.string()));
    sources_.push_back(file);
  }
  void commit() override { written_.keep(); }
  fs::path path_of(std::size_t frame) const {
    return header().frame_count == 1 ? target() : frame_path(target(), frame, ".obj");
  }

  std::vector<fs::path> sources_;
  WrittenFiles written_;
};

}  // namespace

std::string obj_bytes(const MeshData& mesh, const std::string& name) {
  const FpGuard guard;  // to_chars takes a subnormal number for zero where they are flushed
  const std::vector<Group> groups = cover(mesh.groups, mesh.triangles.size(), name);
  std::string text;
  for (const auto& point : mesh.points) {
    text += 'v';
    for (const double x : point) append_number(text, x);
    text += '\n';
  }
  auto group = groups.begin();
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
    if (group != groups.end() && face == static_cast<std::size_t>(group->face_begin)) {
      text += "g " + group++->name + '\n';
    }
    text += 'f';
    for (const std::int32_t corner : mesh.triangles[face]) append_number(text, std::int64_t{corner} + 1);
    text += '\n';
  }
  return text;
}

std::unique_ptr<SequenceOutput> create_obj_output(fs::path target, OutputHeader header) {
  return std::make_unique<ObjOutput>(std::move(target), std::move(header));
}

}  // namespace selvage::io
