// A sequence in memory.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "io/sequence.h"

namespace selvage::testing {

class Frames final : public io::SequenceReader {
 public:
  explicit Frames(std::vector<io::MeshData> frames) : frames_(std::move(frames)) {}
  std::size_t frame_count() const override { return frames_.size(); }
  io::SequenceKind kind() const override { return io::SequenceKind::kSteps; }
  io::Precision precision() const override { return io::Precision::kFloat64; }
  const std::vector<io::Group>& groups() const override { return groups_; }
  std::string frame_name(std::size_t frame) const override { return "memory[" + std::to_string(frame) + "]"; }
  double time(std::size_t frame) const override { return static_cast<double>(frame); }
  bool counts_frames() const override { return false; }
  bool same_faces_as_previous(std::size_t) const override { return true; }
  io::MeshData frame(std::size_t frame) const override { return frames_.at(frame); }

 private:
  std::vector<io::MeshData> frames_;
  std::vector<io::Group> groups_;
};

}  // namespace selvage::testing
