#include "cli/arguments/output_check.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <span>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include "cli/process/exit_code.h"
#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/extension.h"
#include "io/sequence/sequence_json.h"

namespace selvage::cli {
namespace {

namespace fs = std::filesystem;

/// Meshes, and files of sequences.
constexpr auto kSequenceFiles = std::to_array({".npz", ".npy", ".obj", ".ply", ".pc2", ".mdd", ".pvd"});

bool is_named(const fs::path& file, std::span<const char* const> extensions) {
  return std::ranges::any_of(extensions, [&](const char* extension) { return io::has_extension(file, extension); });
}

/// A slip of the hand: reports are named .json, .html, .png or .svg, and replace what they were before. Nothing else
/// may go, under whatever link.
void require_replaceable(const fs::path& output) {
  constexpr auto kKept = std::to_array({".toml", ".csv", ".jsonl", ".bin"});
  std::error_code absent;
  if (!fs::is_regular_file(output, absent)) return;
  const fs::path file = io::behind_links(output);
  if (!is_named(file, kSequenceFiles) && !is_named(file, kKept) && file.filename() != io::kHeaderFile) return;
  throw UsageError(output.string() + " is there already, and a report would take its place; name another file");
}

}  // namespace

void require_no_dash(const fs::path& output) {
  if (output != "-") return;
  throw UsageError("-: results are not written to standard output; name a file, /dev/stdout, or ./- for that name");
}

bool is_standard_output(const fs::path& file) {
  using Status = struct stat;
  Status named{}, out{};
  return !file.empty() && ::stat(file.c_str(), &named) == 0 && ::fstat(STDOUT_FILENO, &out) == 0 &&
         !S_ISCHR(out.st_mode) && named.st_dev == out.st_dev && named.st_ino == out.st_ino;
}

bool is_one_file(const fs::path& a, const fs::path& b) {
  std::error_code absent;
  if (fs::exists(a, absent) || fs::exists(b, absent)) {
    return fs::equivalent(a, b, absent) && fs::is_regular_file(a, absent);
  }
  // Absolute first: a relative name of nothing stays relative.
  const auto place = [&](const fs::path& file) {
    return fs::weakly_canonical(fs::absolute(io::behind_links(file), absent), absent);
  };
  return place(a) == place(b);
}

void require_folder_name(const fs::path& output) {
  require_no_dash(output);
  io::require_nameable(output);
  if (!output.has_filename() || !is_named(output, kSequenceFiles)) return;
  throw UsageError(output.string() + " would be a folder; name one without that extension, and write the file with " +
                   "`selvage convert FOLDER -o FILE`");
}

void require_separate_outputs(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const fs::path& output = outputs[i];
    if (output.empty()) continue;
    require_no_dash(output);
    io::require_nameable(output);
    const auto is_output = [&](const fs::path& other) { return is_one_file(other, output); };
    std::error_code absent;
    // What is not there is not read, however many frames there are to compare with.
    if (fs::exists(output, absent) && std::ranges::any_of(inputs, is_output)) {
      throw UsageError(output.string() + " is read, and would be overwritten; name another file");
    }
    require_replaceable(output);
    for (std::size_t k = 0; k < i; ++k) {
      const bool is_one_stream = is_standard_output(output) && is_standard_output(outputs[k]);  // or a pipe
      if (outputs[k].empty() || (!is_output(outputs[k]) && !is_one_stream)) continue;
      throw UsageError(output.string() + " is named for two outputs, and would be overwritten; name another file");
    }
  }
}

void require_writable(const std::vector<fs::path>& outputs) {
  for (const fs::path& output : outputs) {
    if (output.empty()) continue;
    std::error_code status;
    if (fs::is_directory(output, status)) io::file_error(output.string(), "open", EISDIR);
    if (fs::exists(output, status) && !fs::is_regular_file(output, status)) continue;  // opening a pipe would wait
    if (is_standard_output(output)) continue;
    const io::AtomicFile trial(io::behind_links(output));
  }
}

void require_outputs(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs) {
  require_separate_outputs(inputs, outputs);
  require_writable(outputs);
}

}  // namespace selvage::cli
