// A sequence that is another one but for what a derived class overrides.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/sequence.h"

namespace selvage::cli {

class SequenceDecorator : public io::SequenceReader {
 public:
  explicit SequenceDecorator(std::unique_ptr<io::SequenceReader> inner) : inner_(std::move(inner)) {}
  std::size_t frame_count() const override { return inner_->frame_count(); }
  io::SequenceKind kind() const override { return inner_->kind(); }
  io::Precision precision() const override { return inner_->precision(); }
  const std::vector<io::Group>& groups() const override { return inner_->groups(); }
  std::string frame_name(std::size_t frame) const override { return inner_->frame_name(frame); }
  double time(std::size_t frame) const override { return inner_->time(frame); }
  bool counts_frames() const override { return inner_->counts_frames(); }
  bool same_faces_as_previous(std::size_t frame) const override { return inner_->same_faces_as_previous(frame); }
  io::MeshData frame(std::size_t frame) const override { return inner_->frame(frame); }
  std::string remark() const override { return inner_->remark(); }
  std::int64_t split_polygons() const override { return inner_->split_polygons(); }

 protected:
  [[nodiscard]] const io::SequenceReader& inner() const { return *inner_; }

 private:
  std::unique_ptr<io::SequenceReader> inner_;
};

}  // namespace selvage::cli
