#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "verify/check.h"
#include "verify/fp_guard.h"

namespace selvage::verify {
namespace {

std::vector<std::uint8_t> body_flags(const io::MeshData& mesh) {
  std::vector<std::uint8_t> is_body(mesh.triangles.size(), 0);
  for (const io::Group& group : mesh.groups) {
    if (group.role != io::Group::Role::kBody) continue;
    std::fill(is_body.begin() + group.face_begin, is_body.begin() + group.face_end, std::uint8_t{1});
  }
  return is_body;
}

/// One frame and what its faces are; the topology is made anew only where faces or groups change.
struct Frame {
  std::string name;
  io::Points points;
};

class SequenceCheck {
 public:
  SequenceCheck(const io::SequenceReader& sequence, const SequenceOptions& options)
      : sequence_(sequence), options_(options), start_(std::chrono::steady_clock::now()) {}

  SequenceReport run() {
    const std::size_t count = sequence_.frame_count();
    if (count == 0) throw io::Error(io::ErrorKind::kBadInput, "the sequence holds no frame: there is nothing to check");
    report_.frames_expected = options_.frames ? static_cast<std::int64_t>(count) : 0;
    report_.motions_expected = options_.motions ? static_cast<std::int64_t>(count) - 1 : 0;
    report_.precision = sequence_.precision();
    report_.bodies_checked = options_.check.check_bodies;
    for (std::size_t i = 0; i < count && step(i); ++i) {
    }
    report_.verdict = verdict();
    report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    return std::move(report_);
  }

 private:
  /// Frame i, and the motion that leads to it. False: stop.
  bool step(std::size_t i) {
    if (!report_progress()) return false;
    Frame frame = read(i);
    const bool same_surface = i > 0 && !surface_changed_;
    if (options_.motions && i > 0 && !check_motion_to(i, frame, same_surface)) return false;
    if (options_.frames) check_instant(i, frame);
    previous_ = std::move(frame);
    return true;
  }

  Frame read(std::size_t i) {
    io::MeshData mesh = sequence_.frame(i);
    const std::string name = sequence_.frame_name(i);
    if (mesh.triangles.empty()) {
      throw io::Error(io::ErrorKind::kBadInput, name + ": no faces: there is nothing to check");
    }
    std::vector<std::uint8_t> is_body = body_flags(mesh);
    const auto vertex_count = static_cast<std::int64_t>(mesh.points.size());
    surface_changed_ =
        mesh.triangles != topology_.triangles || is_body != is_body_ || vertex_count != topology_.vertex_count;
    if (surface_changed_) {
      topology_ = make_topology({mesh.triangles, is_body}, mesh.points.size());
      is_body_ = std::move(is_body);
    }
    report_.vertices = vertex_count;
    report_.faces = static_cast<std::int64_t>(mesh.triangles.size());
    report_.unreferenced_vertices = topology_.unreferenced_vertices;
    report_.body_faces = static_cast<std::int64_t>(topology_.faces.body.size());
    for (const Point& p : mesh.points) {
      for (const double x : p) report_.largest_coordinate = std::max(report_.largest_coordinate, std::abs(x));
    }
    return {name, std::move(mesh.points)};
  }

  /// All faces belong to bodies, and pairs of these are not checked: the check would look at nothing.
  bool nothing_to_examine() const { return topology_.faces.cloth.empty() && !options_.check.check_bodies; }

  void check_instant(std::size_t i, const Frame& frame) {
    if (nothing_to_examine()) {
      report_.unchecked.push_back(frame.name + ": all faces belong to bodies, which are checked only when asked for");
      return;
    }
    count(check_frame(topology_, frame.points, options_.check), report_.frames, i);
  }

  bool check_motion_to(std::size_t i, const Frame& frame, bool same_surface) {
    if (!same_surface) {
      report_.unchecked.push_back("motion from " + previous_.name + " to " + frame.name +
                                  ": faces, groups or number of vertices change, so vertices cannot be paired");
      return true;
    }
    if (nothing_to_examine()) {
      report_.unchecked.push_back("motion from " + previous_.name + " to " + frame.name +
                                  ": all faces belong to bodies, which are checked only when asked for");
      return true;
    }
    count(check_motion(topology_, previous_.points, frame.points, options_.check), report_.motions, i - 1);
    return report_progress();
  }

  void count(CheckResult result, SequenceReport::Counted& counted, std::size_t frame) {
    ++counted.checked;
    ++units_done_;
    if (result.violations_total.total() > 0) ++counted.violated;
    report_.pairs += result.pairs;
    report_.violations_total += result.violations_total;
    for (Violation& violation : result.violations) {
      if (report_.violations.size() == options_.check.max_violations) break;
      violation.frame = static_cast<std::int64_t>(frame);
      report_.violations.push_back(std::move(violation));
    }
  }

  bool report_progress() {
    const auto total = static_cast<std::size_t>(report_.frames_expected + report_.motions_expected);
    if (!options_.progress || options_.progress(units_done_, total)) return true;
    report_.unchecked.push_back("stopped on request after " + std::to_string(units_done_) + " of " +
                                std::to_string(total) + " frames and motions");
    return false;
  }

  Verdict verdict() const {
    if (report_.violations_total.total() > 0) return Verdict::kViolated;
    const std::int64_t expected = report_.frames_expected + report_.motions_expected;
    const bool all_checked = report_.frames.checked == report_.frames_expected &&
                             report_.motions.checked == report_.motions_expected && report_.unchecked.empty();
    return expected > 0 && all_checked ? Verdict::kClean : Verdict::kUnknown;
  }

  const io::SequenceReader& sequence_;
  const SequenceOptions& options_;
  std::chrono::steady_clock::time_point start_;
  SequenceReport report_;
  Topology topology_;  // of the frame read last
  std::vector<std::uint8_t> is_body_;
  bool surface_changed_ = false;
  Frame previous_;
  std::size_t units_done_ = 0;
};

}  // namespace

SequenceReport check_sequence(const io::SequenceReader& sequence, const SequenceOptions& options) {
  const FpGuard guard;  // the readers convert numbers: a float32 or text that is subnormal, or rounds
  return SequenceCheck(sequence, options).run();
}

}  // namespace selvage::verify
