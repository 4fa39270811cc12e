#include "cli/arguments/named_bodies.h"

#include <algorithm>
#include <utility>

#include "cli/arguments/group_names.h"
#include "cli/arguments/sequence_decorator.h"

namespace selvage::cli {
namespace {

class NamedBodies final : public SequenceDecorator {
 public:
  NamedBodies(std::unique_ptr<io::SequenceReader> sequence, const std::vector<std::string>& names,
              const std::vector<io::Group>& own)
      : SequenceDecorator(std::move(sequence)), names_(names), groups_(inner().groups()) {
    std::vector<io::Group> known = groups_;
    known.insert(known.end(), own.begin(), own.end());
    require_known("--body", names, known);
    std::ranges::copy_if(own, std::back_inserter(own_), [&](const io::Group& group) { return is_named(group); });
    for (io::Group& group : own_) group.role = io::Group::Role::kBody;
    mark(groups_);
  }

  const std::vector<io::Group>& groups() const override { return groups_; }
  io::MeshData frame(std::size_t frame) const override {
    io::MeshData mesh = SequenceDecorator::frame(frame);
    mark(mesh.groups);
    // A range that is none of this mesh is refused by the checker, which names it.
    std::ranges::copy_if(own_, std::back_inserter(mesh.groups), [&](const io::Group& group) {
      return 0 <= group.face_begin && group.face_begin < group.face_end &&
             static_cast<std::size_t>(group.face_end) <= mesh.triangles.size();
    });
    return mesh;
  }

 private:
  [[nodiscard]] bool is_named(const io::Group& group) const {
    return std::ranges::find(names_, group.name) != names_.end();
  }
  void mark(std::vector<io::Group>& groups) const {
    for (io::Group& group : groups) {
      if (is_named(group)) group.role = io::Group::Role::kBody;
    }
  }

  std::vector<std::string> names_;
  std::vector<io::Group> groups_, own_;
};

}  // namespace

std::unique_ptr<io::SequenceReader> with_bodies(std::unique_ptr<io::SequenceReader> sequence,
                                                const std::vector<std::string>& names,
                                                const std::vector<io::Group>& own) {
  if (names.empty()) return sequence;
  return std::make_unique<NamedBodies>(std::move(sequence), names, own);
}

}  // namespace selvage::cli
