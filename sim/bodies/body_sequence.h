// The surface of a body that a sequence of meshes animates: a figure from an animation program.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "io/sequence.h"
#include "sim/bodies/one_place.h"
#include "sim/scene/scene.h"
#include "sim/scene/shapes.h"

namespace selvage::sim {

/// Vertices go straight from frame to frame; before the first frame and after the last they stand still. What a step
/// of a simulation certifies is the motion between two of its own states, wherever the frames lie.
class BodySequence {
 public:
  /// Opens the files of `spec`, relative to the folder of `scene_file`, and goes through all frames once. Throws
  /// io::Error with the line of the scene where one cannot be read, has other faces than the first or a coordinate out
  /// of range, or where nothing says when it is.
  BodySequence(const SequenceSpec& spec, const std::filesystem::path& scene_file);

  /// Of the first frame, m.
  [[nodiscard]] const Shape& first() const { return first_; }
  /// Of all frames, whichever a run comes to: with more of them it is the same scene.
  [[nodiscard]] const OnePlace& one_place() const { return one_place_; }
  /// #V by 3, m; the frame's own numbers, to the bit, at its time. Reads a frame where it is none of the last two that
  /// were needed, and throws io::Error where that fails. From several threads.
  [[nodiscard]] Positions at(double time_s) const;
  [[nodiscard]] std::size_t frame_count() const { return times_s_.size(); }
  /// In the scene's time.
  [[nodiscard]] double begin_s() const { return times_s_.front(); }
  [[nodiscard]] double end_s() const { return times_s_.back(); }
  /// The times of the frames between two times, these left out; in order.
  [[nodiscard]] std::vector<double> frames_between(double t0_s, double t1_s) const;
  /// Of all times and positions: two sequences that differ have another one, but for chance.
  [[nodiscard]] std::uint32_t checksum() const { return checksum_; }

 private:
  using Frame = std::shared_ptr<const Positions>;

  [[nodiscard]] Positions read(std::size_t frame) const;
  [[nodiscard]] Frame kept(std::size_t frame) const;

  SequenceSpec spec_;
  std::filesystem::path scene_file_;
  std::shared_ptr<const io::SequenceReader> reader_;
  std::vector<double> times_s_;
  Shape first_;
  OnePlace one_place_;
  std::uint32_t checksum_ = 0;

  mutable std::mutex mutex_;
  struct Kept {
    std::size_t number = 0;
    Frame x;
  };
  mutable std::array<Kept, 2> kept_;  ///< an even and an odd frame
};

}  // namespace selvage::sim
