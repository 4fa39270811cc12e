// Writes the sequence folder through SequenceWriter, and takes it back where the sequence does not come to its end. The
// header is written last: what is killed before is no sequence, which would be checked as if it were whole.
#include <system_error>
#include <utility>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/sequence/sequence_outputs.h"

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
  FolderOutput(fs::path folder, OutputHeader all)
      : SequenceOutput(absent_or_empty(std::move(folder)), std::move(all)),
        writer_(target(), header().sequence, false, HeaderTime::kLast) {}
  ~FolderOutput() override {
    if (!is_finished_) writer_.discard();
  }
  std::vector<fs::path> sources() const override { return {target()}; }

 private:
  void write_frame(double time_s, const MeshData& mesh) override {
    require_same_mesh(header(), mesh, OutputFormat::kFolder, target());
    writer_.append(time_s, mesh.points);
  }
  void commit() override {
    writer_.write_header();
    is_finished_ = true;
  }

  SequenceWriter writer_;
  bool is_finished_ = false;
};

}  // namespace

std::unique_ptr<SequenceOutput> create_folder_output(fs::path target, OutputHeader header) {
  return std::make_unique<FolderOutput>(std::move(target), std::move(header));
}

}  // namespace selvage::io
