#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "verify/arithmetic/fp_guard.h"
#include "verify/check.h"
#include "verify/frame_source.h"
#include "verify/smallest_gap.h"

namespace selvage::verify {
namespace {

class SequenceCheck {
 public:
  SequenceCheck(const io::SequenceReader& sequence, const SequenceOptions& options)
      : sequence_(sequence), options_(options), start_(std::chrono::steady_clock::now()) {}

  SequenceReport run() {
    const std::size_t count = sequence_.frame_count();
    if (count == 0) throw io::Error(io::ErrorKind::kBadInput, "the sequence holds no frame: there is nothing to check");
    const auto [first, end] = options_.range.value_or(std::pair{std::size_t{0}, count});
    if (!(first < end && end <= count))
      throw std::invalid_argument("check_sequence: no range of the sequence's frames");
    source_.emplace(sequence_, options_.rules, options_.weld);
    begin(first, end);
    if (first > 0) read_before(first);
    if (options_.resume_from == nullptr || resume(*options_.resume_from, first)) {
      std::size_t next = first + report_.frame_crc32.size();
      try {
        while (next < end && step(next)) ++next;
      } catch (const Stopped&) {
        note_stop("on request");
      }
    }
    report_.verdict = verdict_of(report_);
    report_.seconds = seconds();
    return std::move(report_);
  }

 private:
  void begin(std::size_t first, std::size_t end) {
    report_.sequence = sequence_identity(sequence_);
    report_.frame_count = static_cast<std::int64_t>(sequence_.frame_count());
    report_.first_frame = static_cast<std::int64_t>(first);
    report_.end_frame = static_cast<std::int64_t>(end);
    report_.frames_expected = options_.frames ? report_.end_frame - report_.first_frame : 0;
    report_.motions_expected =
        options_.motions ? report_.end_frame - std::max<std::int64_t>(report_.first_frame, 1) : 0;
    report_.precision = sequence_.precision();
    report_.bodies_checked = options_.check.check_bodies;
    report_.second_opinion = options_.check.second_opinion;
    report_.gap_searched = options_.gap;
    report_.max_violations = static_cast<std::int64_t>(options_.check.max_violations);
    for (const auto& groups : options_.rules.exempt) report_.exempted.push_back({groups, 0});
    for (const std::string& group : options_.rules.ignore) report_.ignored.push_back({group, 0});
    if (options_.weld) report_.welded = {source_->welded_vertices(), 0};
  }

  /// Takes over what an earlier run has found, once all of its frames are known to be the same: a result speaks of the
  /// bits that were checked, not of whatever has the files' names now. False: stop.
  bool resume(const SequenceReport& earlier, std::size_t first) {
    if (earlier.sequence != report_.sequence || earlier.first_frame != report_.first_frame ||
        earlier.end_frame != report_.end_frame) {
      throw io::Error(io::ErrorKind::kBadInput, "the run to be resumed was on another sequence; start anew");
    }
    if (earlier.max_violations != report_.max_violations) {
      throw io::Error(io::ErrorKind::kBadInput,
                      "the run to be resumed lists " + std::to_string(earlier.max_violations) +
                          " violations at most (--max-violations), not " + std::to_string(report_.max_violations) +
                          "; resume it with that, or start anew");
    }
    const std::size_t done = earlier.frame_crc32.size();
    if (done > 0 && first > 0) require_same(previous_, earlier.crc32_before, earlier.surface_crc32_before);
    for (std::size_t k = 0; k < done; ++k) {
      if (!report_progress()) {
        if (options_.checkpoint) options_.checkpoint(earlier);  // not compared to the end, but not lost
        return false;
      }
      previous_ = read(first + k);
      const bool has_surface = k < earlier.surface_crc32.size();
      require_same(previous_, earlier.frame_crc32[k],
                   has_surface ? std::optional(earlier.surface_crc32[k]) : std::nullopt);
    }
    report_ = earlier;
    seconds_before_ = earlier.seconds;
    units_done_ = static_cast<std::size_t>(report_.frames.checked + report_.motions.checked);
    return true;
  }

  static void require_same(const Frame& frame, std::optional<std::uint32_t> crc32,
                           std::optional<std::uint32_t> surface_crc32) {
    if (crc32 == frame.crc32 && surface_crc32 == frame.surface_crc32) return;
    const std::string what = crc32 != frame.crc32 ? "positions" : "faces, groups or welded vertices";
    throw io::Error(io::ErrorKind::kBadInput, frame.name + ": its " + what +
                                                  " are not those that the run to be resumed has checked; start anew, "
                                                  "without --resume");
  }

  /// The frame before the range: the first motion starts there.
  void read_before(std::size_t first) {
    previous_ = read(first - 1);
    report_.crc32_before = previous_.crc32;
    report_.surface_crc32_before = previous_.surface_crc32;
  }

  /// Frame i, and the motion that leads to it. False: stop.
  bool step(std::size_t i) {
    if (!report_progress() || is_decided()) return false;
    Frame frame = read(i);
    if (options_.motions && i > 0 && !check_motion_to(i, frame)) return false;
    if (options_.frames) check_instant(i, frame);
    report_.frame_crc32.push_back(frame.crc32);
    report_.surface_crc32.push_back(frame.surface_crc32);
    previous_ = std::move(frame);
    if (options_.checkpoint) {
      report_.seconds = seconds();
      report_.verdict = verdict_of(report_);
      options_.checkpoint(report_);
    }
    return true;
  }

  Frame read(std::size_t i) {
    Frame frame = source_->read(i);
    const Topology& topology = source_->topology();
    report_.vertices = topology.vertex_count;
    report_.faces = source_->face_count();
    report_.unreferenced_vertices = topology.unreferenced_vertices;
    report_.body_faces = static_cast<std::int64_t>(topology.faces.body.size());
    for (std::size_t k = 0; k < report_.ignored.size(); ++k) {
      report_.ignored[k].faces = source_->rules().ignored_faces[k];
    }
    if (report_.welded) report_.welded->collapsed_faces = source_->collapsed_faces();
    for (const Point& p : frame.points) {
      for (const double x : p) report_.largest_coordinate = std::max(report_.largest_coordinate, std::abs(x));
    }
    return frame;
  }

  /// Why a check would look at nothing, or null. A face that is neither ignored nor a body's is owed a check of its
  /// area whatever may touch.
  const char* nothing_to_examine() const {
    const Parts& faces = source_->topology().faces;
    if (faces.cloth.empty() && faces.body.empty()) return "all faces are ignored";
    if (faces.cloth.empty() && !options_.check.check_bodies) {
      return "all faces belong to bodies, which are checked only when asked for";
    }
    return nullptr;
  }

  /// The rules leave no pair of faces: each face alone is checked, and where that finds nothing it is no clean
  /// sequence.
  void note_absence_of_pairs(const std::string& unit) {
    const bool has_rules = !options_.rules.exempt.empty() || !options_.rules.ignore.empty();
    if (!has_rules || owes_pairs(source_->topology(), options_.check.check_bodies)) return;
    report_.unchecked.push_back(unit +
                                "every pair of faces is exempt or ignored; only each face's own area was checked");
  }

  void check_instant(std::size_t i, const Frame& frame) {
    if (const char* why = nothing_to_examine()) {
      report_.unchecked.push_back(frame.name + ": " + why);
      return;
    }
    note_absence_of_pairs(frame.name + ": ");
    count(check_frame(source_->topology(), frame.points, options_.check), i, false);
    if (!options_.gap) return;
    std::optional<Gap> gap = smallest_gap(source_->topology(), frame.points, options_.check);
    if (gap) gap->frame = static_cast<std::int64_t>(i);
    if (gap && (!report_.gap || is_smaller(*gap, *report_.gap))) report_.gap = gap;
  }

  bool check_motion_to(std::size_t i, const Frame& frame) {
    const std::string motion = "motion from " + previous_.name + " to " + frame.name + ": ";
    if (source_->surface_changed()) {
      report_.unchecked.push_back(motion + "faces, groups or number of vertices change, so vertices cannot be paired");
      return true;
    }
    if (const char* why = nothing_to_examine()) {
      report_.unchecked.push_back(motion + why);
      return true;
    }
    note_absence_of_pairs(motion);
    count(check_motion(source_->topology(), previous_.points, frame.points, options_.check), i - 1, true);
    return report_progress();
  }

  void count(CheckResult result, std::size_t frame, bool motion) {
    SequenceReport::Counted& counted = motion ? report_.motions : report_.frames;
    ++counted.checked;
    ++units_done_;
    if (result.violations_total.total() > 0) {
      ++counted.violated;
      report_.violated.push_back({static_cast<std::int64_t>(frame), motion, result.violations_total});
    }
    report_.pairs += result.pairs;
    report_.violations_total += result.violations_total;
    for (std::size_t rule = 0; rule < result.exempted.size(); ++rule) {
      report_.exempted[rule].pairs += result.exempted[rule];
    }
    for (Violation& violation : result.disagreements) {
      if (report_.disagreements.size() == options_.check.max_violations) break;
      violation.frame = static_cast<std::int64_t>(frame);
      report_.disagreements.push_back(std::move(violation));
    }
    for (Violation& violation : result.violations) {
      if (report_.violations.size() == options_.check.max_violations) break;
      violation.frame = static_cast<std::int64_t>(frame);
      report_.violations.push_back(std::move(violation));
    }
  }

  bool report_progress() {
    if (!options_.progress || options_.progress(units_done_, unit_count())) return true;
    note_stop("on request");
    return false;
  }

  /// Whether no more is asked than what is known. Says so.
  bool is_decided() {
    if (!options_.stop_at_violation || report_.violations_total.total() == 0) return false;
    note_stop("at the first violation");
    return true;
  }

  void note_stop(const std::string& where) {
    report_.unchecked.push_back("stopped " + where + " after " + std::to_string(units_done_) + " of " +
                                std::to_string(unit_count()) + " frames and motions");
  }

  std::size_t unit_count() const {
    return static_cast<std::size_t>(report_.frames_expected + report_.motions_expected);
  }

  double seconds() const {
    return seconds_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  const io::SequenceReader& sequence_;
  const SequenceOptions& options_;
  std::chrono::steady_clock::time_point start_;
  double seconds_before_ = 0;  // of the run that is resumed
  SequenceReport report_;
  std::optional<FrameSource> source_;
  Frame previous_;
  std::size_t units_done_ = 0;
};

}  // namespace

Verdict verdict_of(const SequenceReport& report) {
  if (report.pairs.disagreed > 0) return Verdict::kUnknown;
  if (report.violations_total.total() > 0) return Verdict::kViolated;
  const bool all_checked = report.frames.checked == report.frames_expected &&
                           report.motions.checked == report.motions_expected && report.unchecked.empty();
  return report.frames_expected + report.motions_expected > 0 && all_checked ? Verdict::kClean : Verdict::kUnknown;
}

bool is_complete(const SequenceReport& report) {
  return static_cast<std::int64_t>(report.frame_crc32.size()) == report.end_frame - report.first_frame;
}

SequenceReport check_sequence(const io::SequenceReader& sequence, const SequenceOptions& options) {
  const FpGuard guard;  // the readers convert numbers: a float32 or text that is subnormal, or rounds
  return SequenceCheck(sequence, options).run();
}

}  // namespace selvage::verify
