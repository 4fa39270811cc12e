// Writes the sequence folder through SequenceWriter, and takes it back where the sequence does not come to its end.
#include <system_error>
#include <utility>
#include <vector>

#include "io/sequence_outputs.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

/// A folder that was absent or empty before, as it is again unless it is kept.
class NewFolder {
 public:
  explicit NewFolder(fs::path folder) : folder_(std::move(folder)) {
    std::error_code status;
    if (!fs::is_directory(folder_, status)) {
      require_absent(folder_);
      made_ = folder_;
      for (fs::path above = made_.parent_path(); !above.empty() && !fs::exists(above, status);
           above = above.parent_path()) {
        made_ = above;
      }
    } else if (!fs::is_empty(folder_, status)) {
      throw Error(ErrorKind::kFile, folder_.string() + ": is a folder that is not empty; choose another");
    }
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  ~NewFolder() {
    std::error_code status;
    if (is_kept_) return;
    if (!made_.empty()) fs::remove_all(made_, status);
    std::vector<fs::path> files;  // of a folder that is somebody's, perhaps behind a link
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_, status)) files.push_back(entry.path());
    for (const fs::path& file : files) fs::remove_all(file, status);
  }
  const fs::path& path() const { return folder_; }
  void keep() { is_kept_ = true; }

 private:
  fs::path folder_;
  fs::path made_;  ///< the uppermost folder that was absent
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
