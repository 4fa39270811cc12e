#include "sim/bodies/body_sequence.h"

#include <algorithm>

#include "io/file/checksum.h"
#include "io/numbered_files.h"
#include "kernel/mesh.h"
#include "sim/bodies/mesh_shape.h"

namespace selvage::sim {
namespace {

std::unique_ptr<io::SequenceReader> open(const SequenceSpec& spec, const std::filesystem::path& folder) {
  const std::filesystem::path base = spec.base.empty() ? spec.base : folder / spec.base;
  auto reader = io::open_sequence(io::numbered_files(folder / spec.file), base);
  if (reader->frame_count() > 0) return reader;
  throw io::Error(io::ErrorKind::kBadInput, spec.file.string() + " holds no frame; name another sequence");
}

std::vector<double> times_of(const io::SequenceReader& reader, const SequenceSpec& spec) {
  const bool has_seconds = io::has_times(reader);
  if (!spec.frames_per_s && !has_seconds && reader.frame_count() > 1) {
    throw io::Error(io::ErrorKind::kBadInput,
                    spec.file.string() + " does not say when its frames are; add frames_per_s");
  }
  std::vector<double> times_s;
  for (std::size_t i = 0; i < reader.frame_count(); ++i) {
    double since_first = reader.time(i) - reader.time(0);
    if (spec.frames_per_s) since_first = (has_seconds ? static_cast<double>(i) : since_first) / *spec.frames_per_s;
    times_s.push_back(spec.start_s + since_first);
    if (i == 0 || times_s[i - 1] < times_s[i]) continue;
    throw io::Error(
        io::ErrorKind::kBadInput,
        reader.frame_name(i) + " is no later than the frame before it; give frames_per_s, or correct the times");
  }
  return times_s;
}

template <class Number>
std::uint32_t checksum_of(const Number* numbers, std::size_t count, std::uint32_t start) {
  return io::crc32({reinterpret_cast<const char*>(numbers), count * sizeof(Number)}, start);
}

}  // namespace

BodySequence::BodySequence(const SequenceSpec& spec, const std::filesystem::path& scene_file)
    : spec_(spec), scene_file_(scene_file) {
  read_for_line(scene_file_, spec_.line, "sequence", [&] {
    reader_ = open(spec_, scene_file_.parent_path());
    times_s_ = times_of(*reader_, spec_);
    first_.triangles = reader_->frame(0).triangles;
  });
  checksum_ = checksum_of(times_s_.data(), times_s_.size(), 0);
  for (std::size_t i = 0; i < times_s_.size(); ++i) {
    Positions x = read(i);
    checksum_ = checksum_of(x.data(), static_cast<std::size_t>(x.size()), checksum_);
    one_place_.narrow(x);
    if (i == 0) first_.x = std::move(x);
  }
  first_.remark = reader_->remark();
}

Positions BodySequence::read(std::size_t frame) const {
  return read_for_line(scene_file_, spec_.line, "sequence", [&] {
    const io::MeshData mesh = reader_->frame(frame);
    const std::string name = reader_->frame_name(frame);
    if (mesh.triangles != first_.triangles || (frame > 0 && std::ssize(mesh.points) != first_.x.rows())) {
      throw io::Error(io::ErrorKind::kBadInput,
                      name + " has other faces or vertices than the first frame; a body keeps its mesh");
    }
    return scaled_positions(mesh.points, spec_.scale, name);
  });
}

BodySequence::Frame BodySequence::kept(std::size_t frame) const {
  const std::lock_guard lock(mutex_);
  Kept& kept = kept_[frame % kept_.size()];
  if (!kept.x || kept.number != frame) kept = {frame, std::make_shared<const Positions>(read(frame))};
  return kept.x;
}

std::vector<double> BodySequence::frames_between(double t0_s, double t1_s) const {
  const auto first = std::ranges::upper_bound(times_s_, t0_s);
  return {first, std::ranges::lower_bound(first, times_s_.end(), t1_s)};
}

Positions BodySequence::at(double time_s) const {
  const auto next = static_cast<std::size_t>(std::ranges::upper_bound(times_s_, time_s) - times_s_.begin());
  if (next == 0) return first_.x;
  const Frame before = kept(next - 1);
  if (next == times_s_.size() || time_s == times_s_[next - 1]) return *before;
  const double share = (time_s - times_s_[next - 1]) / (times_s_[next] - times_s_[next - 1]);
  return *before + share * (*kept(next) - *before);
}

}  // namespace selvage::sim
