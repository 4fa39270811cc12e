// Writes the sequence folder through SequenceWriter, and takes it back where the sequence does not come to its end.
#include <system_error>
#include <utility>
#include <vector>

#include "io/sequence_outputs.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

fs::path absent_or_empty(fs::path folder) {
  std::error_code status;
  if (!fs::is_directory(folder, status)) {
    require_absent(folder);
  } else if (!fs::is_empty(folder, status)) {
    throw Error(ErrorKind::kFile, folder.string() + ": is a folder that is not empty; choose another");
  }
  return folder;
}

class FolderOutput final : public SequenceOutput {
 public:
  FolderOutput(fs::path target, OutputHeader header)
      : folder_(absent_or_empty(std::move(target))), header_(std::move(header)), writer_(folder_, header_.sequence) {}
  FolderOutput(const FolderOutput&) = delete;
  FolderOutput& operator=(const FolderOutput&) = delete;
  ~FolderOutput() override {
    if (!is_finished_) writer_.discard();
  }

  void append(double time_s, const MeshData& mesh) override {
    require_same_mesh(header_, mesh, OutputFormat::kFolder, folder_);
    writer_.append(time_s, mesh.points);
  }
  void finish() override { is_finished_ = true; }
  std::vector<fs::path> sources() const override { return {folder_}; }

 private:
  fs::path folder_;
  OutputHeader header_;
  SequenceWriter writer_;
  bool is_finished_ = false;
};

}  // namespace

std::unique_ptr<SequenceOutput> create_folder_output(fs::path target, OutputHeader header) {
  return std::make_unique<FolderOutput>(std::move(target), std::move(header));
}

}  // namespace selvage::io
