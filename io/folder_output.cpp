// Writes the sequence folder through SequenceWriter, and takes it back where the sequence does not come to its end.
#include <system_error>
#include <utility>

#include "io/sequence_outputs.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

/// Removes a folder that was absent or empty before, with what was written to it, unless it is kept.
class NewFolder {
 public:
  explicit NewFolder(fs::path folder) : folder_(std::move(folder)) {
    std::error_code status;
    if (!fs::is_directory(folder_, status)) {
      require_absent(folder_);
    } else if (!fs::is_empty(folder_, status)) {
      throw Error(ErrorKind::kFile, folder_.string() + ": is a folder that is not empty; choose another");
    }
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  ~NewFolder() {
    std::error_code status;
    if (!is_kept_) fs::remove_all(folder_, status);
  }
  const fs::path& path() const { return folder_; }
  void keep() { is_kept_ = true; }

 private:
  fs::path folder_;
  bool is_kept_ = false;
};

class FolderOutput final : public SequenceOutput {
 public:
  FolderOutput(fs::path target, OutputHeader header)
      : folder_(std::move(target)), header_(std::move(header)), writer_(folder_.path(), header_.sequence) {}

  void append(double time_s, const MeshData& mesh) override {
    require_same_mesh(header_, mesh, folder_.path());
    writer_.append(time_s, mesh.points);
  }
  void finish() override { folder_.keep(); }
  std::vector<fs::path> sources() const override { return {folder_.path()}; }

 private:
  NewFolder folder_;
  OutputHeader header_;
  SequenceWriter writer_;
};

}  // namespace

std::unique_ptr<SequenceOutput> create_folder_output(fs::path target, OutputHeader header) {
  return std::make_unique<FolderOutput>(std::move(target), std::move(header));
}

}  // namespace selvage::io
