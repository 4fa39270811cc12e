// Writes PC2, float32 in little endian, and its base mesh as OBJ beside it. The cache appears last and whole.
#include <limits>
#include <utility>

#include "io/atomic_file.h"
#include "io/fail.h"
#include "io/point_cache.h"
#include "io/points.h"
#include "io/sequence_outputs.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

class Pc2Output final : public SequenceOutput {
 public:
  Pc2Output(fs::path target, OutputHeader header)
      : base_(fs::path(target).replace_extension(".obj")), header_(std::move(header)), cache_(std::move(target)) {
    constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
    const std::string name = cache_.target().string();
    if (header_.frame_count > kMost || header_.vertex_count > kMost) {
      bad_input(name, "more than 2^31 frames or vertices; split the sequence");
    }
    written_.claim(cache_.target());
    require_absent(base_);
    cache_.write(
        pc2_header(static_cast<std::uint32_t>(header_.vertex_count), static_cast<std::uint32_t>(header_.frame_count)));
  }
  void append(double, const MeshData& mesh) override {
    require_same_mesh(header_, mesh, OutputFormat::kPc2, cache_.target());
    if (is_first_) written_.write(base_, obj_bytes(mesh, base_.string()));
    is_first_ = false;
    std::string bytes;
    append_points(bytes, mesh.points, Precision::kFloat32, cache_.target().string());
    cache_.write(bytes);
  }
  void finish() override {
    cache_.commit();
    written_.keep();
  }
  std::vector<fs::path> sources() const override { return {cache_.target()}; }

 private:
  fs::path base_;
  OutputHeader header_;
  AtomicFile cache_;
  WrittenFiles written_;
  bool is_first_ = true;
};

}  // namespace

std::unique_ptr<SequenceOutput> create_pc2_output(fs::path target, OutputHeader header) {
  return std::make_unique<Pc2Output>(std::move(target), std::move(header));
}

}  // namespace selvage::io
