// Checks of a frame, of the motion between two frames, and of a whole sequence: what was examined, what was violated.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/sequence.h"
#include "verify/decision/exact_motion.h"
#include "verify/decision/second_opinion.h"
#include "verify/surface/group_rules.h"
#include "verify/surface/topology.h"

namespace selvage::verify {

enum class EventKind : std::uint8_t { kVf, kEe, kOverlap, kSelf };

struct Violation {
  std::int64_t frame = 0;  ///< the frame; for motions the frame that the motion starts from
  bool motion = false;
  EventKind event = EventKind::kOverlap;
  /// Motions: touch, cross. Overlaps: touch, cross, overlap (coplanar), fold, duplicate. Self: degenerate (frames),
  /// touch (motions). Frames with a minimum distance: near.
  std::string kind;
  /// vertex, face | edge, edge | face, face | vertex, its face. Edges are numbered as in Topology.
  std::array<std::int32_t, 2> features{};
  /// Their vertices, -1 where there are fewer than six. Self: the vertex, then the opposite edge.
  std::array<std::int32_t, 6> vertices{};
  ExactTime t;                    ///< motions only
  std::vector<Point> x_t0, x_t1;  ///< of the vertices, as stored: these bits are the case; the same twice for a frame
  std::vector<Point> at_touch;    ///< at the first touch, rounded: where to look
  std::string case_file;          ///< where the case was written, if it was
};

struct PairCounts {
  std::int64_t vf = 0, ee = 0, overlap = 0, self = 0;  ///< examined: boxes overlap, in motions on a lattice of 32 bits
  std::int64_t exact = 0;                              ///< needed exact arithmetic
  std::int64_t asked_again = 0, disagreed = 0;         ///< of the second opinion

  PairCounts& operator+=(const PairCounts& other);
};
struct ViolationCounts {
  std::int64_t vf = 0, ee = 0, overlap = 0, self = 0;

  [[nodiscard]] std::int64_t total() const { return vf + ee + overlap + self; }
  ViolationCounts& operator+=(const ViolationCounts& other);
};

/// Which pairs are decided again by the second opinion: none, those that a filter did not decide and all that touch, or
/// all. (The minimum distance has no second decider.)
enum class SecondOpinionScope : std::uint8_t { kNone, kUndecided, kAll };

struct CheckResult {
  PairCounts pairs;
  ViolationCounts violations_total;
  std::vector<Violation> violations;  ///< the first max_violations in (event, features) order
  /// Pairs on which the second opinion differs, as violations, whether or not they are counted as such; the first
  /// max_violations. Their kind is what the first decider says: "touches" or "apart".
  std::vector<Violation> disagreements = {};
  std::vector<std::int64_t> exempted =
      {};  ///< pairs left out, by exemption of the surface; trailing zeros may be missing
  /// The work of the search for pairs: blocks of elements that it compared. Any other search might compare others.
  std::int64_t block_pairs = 0;
};

/// Asked between blocks of pairs and within large ones, from several threads: whether to give the check up.
using Stop = std::function<bool()>;
/// What a check throws that was given up.
struct Stopped {};

struct CheckOptions {
  std::size_t max_violations = 100;
  /// Frames: every vertex at least this far from every face that does not hold it, every edge from every edge with no
  /// common vertex; exactly. (Features that touch by construction, and those of one face, are not compared.)
  std::optional<double> min_distance;
  SecondOpinionScope second_opinion = SecondOpinionScope::kNone;
  SecondDeciders second_deciders = {};
  bool check_bodies = false;  ///< also what concerns bodies alone: pairs of body features, zero-area body faces
  Stop stop = {};             ///< a frame that collapsed to a point has as many pairs as there are
};

/// One instant: all triangle pairs, shared vertices and edges included, and zero-area faces. In parallel,
/// deterministic. Throws std::invalid_argument where V does not fit the surface or is not finite, and Stopped.
[[nodiscard]] CheckResult check_frame(const Topology& topology, std::span<const Point> V, const CheckOptions& options);
[[nodiscard]] CheckResult check_frame(const Surface& surface, std::span<const Point> V, const CheckOptions& options);
/// The straight motion over closed [0,1]: vertex-face, edge-edge, and each vertex against its own opposite edge. From a
/// frame without violations, no event means no intersection at any time (docs/guarantee-checker.md); the motion alone
/// does not see what crosses already at t = 0 and keeps crossing.
[[nodiscard]] CheckResult check_motion(const Topology& topology, std::span<const Point> V_t0,
                                       std::span<const Point> V_t1, const CheckOptions& options);
[[nodiscard]] CheckResult check_motion(const Surface& surface, std::span<const Point> V_t0, std::span<const Point> V_t1,
                                       const CheckOptions& options);

/// The smallest distance of features without a common vertex, within doubles that are neighbours or equal.
struct Gap {
  double lower = 0, upper = 0;
  std::int64_t frame = 0;
  EventKind event = EventKind::kVf;  ///< kVf or kEe
  std::array<std::int32_t, 2> features{};
  /// Of the features' vertices, as stored: two gaps within the same doubles are told apart by them. Empty in a report
  /// of an earlier version.
  std::vector<Point> x = {};
};

enum class Verdict : std::uint8_t { kClean, kViolated, kUnknown };

/// The faces of an overlap, or twice the face without area. REQUIRES a violation of a frame.
[[nodiscard]] inline std::array<std::int32_t, 2> faces_of(const Violation& violation) {
  const bool one_face = violation.event == EventKind::kSelf;  // features: a vertex, and its face
  return {violation.features[one_face ? 1 : 0], violation.features[1]};
}

struct SequenceReport;

struct SequenceOptions {
  CheckOptions check;
  bool frames = true, motions = true;
  /// Called between units of work with (done, total); returning false stops the check, and the verdict is kUnknown. So
  /// does check.stop, within a unit, which then counts as not checked.
  std::function<bool(std::size_t, std::size_t)> progress;
  /// Stop behind the first frame that is violated, itself or in the motion that leads to it.
  bool stop_at_violation = false;
  GroupRules rules = {};
  bool gap = false;   ///< find the smallest gap of all frames that are checked
  bool weld = false;  ///< vertices at the same place in every frame are one; reads the whole sequence beforehand
  /// The frames to check, with the motions that lead to them, [first, second); nothing: all. Part of a sequence.
  std::optional<std::pair<std::size_t, std::size_t>> range = {};
  /// What an earlier call gave to `checkpoint`, with the same sequence and options: its frames are not checked again.
  /// They are read, and io::Error is thrown where one has other bits than then, or the sequence is another one.
  const SequenceReport* resume_from = nullptr;
  /// Called after every frame with the report so far.
  std::function<void(const SequenceReport&)> checkpoint = {};
};

/// Two reports are about one sequence if these are equal: the number of frames, faces, first and last frame.
[[nodiscard]] std::string sequence_identity(const io::SequenceReader& sequence);

struct SequenceReport {
  Verdict verdict = Verdict::kUnknown;
  struct Counted {
    std::int64_t checked = 0, violated = 0;
  } frames, motions;
  std::int64_t frames_expected = 0, motions_expected = 0;  ///< clean needs checked == expected (V3)
  std::string sequence;                                    ///< sequence_identity()
  std::int64_t frame_count = 0;                            ///< of the sequence
  std::int64_t first_frame = 0, end_frame = 0;             ///< what this report is about: all, or a part
  /// CRC-32 of the positions of frames first_frame, ..., as far as they were checked, and of the frame before: they tie
  /// the verdict to the bits, and parts to each other.
  std::vector<std::uint32_t> frame_crc32;
  std::optional<std::uint32_t> crc32_before;
  /// The same of their surfaces: faces, bodies, what is exempt, ignored and welded. Of the program's own making: only
  /// equality means anything.
  std::vector<std::uint32_t> surface_crc32;
  std::optional<std::uint32_t> surface_crc32_before;
  PairCounts pairs;
  ViolationCounts violations_total;
  struct Violated {
    std::int64_t frame = 0;  ///< as Violation::frame
    bool motion = false;
    ViolationCounts counts;
  };
  std::vector<Violated> violated;  ///< every frame and motion with a violation, in the order in which they were checked
  std::vector<Violation> violations;
  std::int64_t max_violations = 0;  ///< CheckOptions::max_violations
  SecondOpinionScope second_opinion = SecondOpinionScope::kNone;
  std::vector<Violation> disagreements;  ///< CheckResult::disagreements: where there is one, the verdict is unknown
  bool gap_searched = false;
  std::optional<Gap> gap;  ///< the smallest of all frames, the first of equals; nothing where no frame has a pair
  std::vector<std::string> unchecked;  ///< what was to be checked and was not, and why: never clean
  io::Precision precision = io::Precision::kFloat64;
  double largest_coordinate = 0;           ///< magnitude, over all frames
  std::int64_t vertices = 0, faces = 0;    ///< of the last frame
  std::int64_t unreferenced_vertices = 0;  ///< no part of any face: not checked, and said so; of the last frame
  std::int64_t body_faces = 0;             ///< of the last frame
  bool bodies_checked = false;             ///< CheckOptions::check_bodies
  struct Exempted {
    std::array<std::string, 2> groups;
    std::int64_t pairs = 0;  ///< left out; a pair that several exemptions cover counts under the first
  };
  std::vector<Exempted> exempted;  ///< as GroupRules::exempt
  struct Ignored {
    std::string group;
    std::int64_t faces = 0;  ///< of the last frame
  };
  std::vector<Ignored> ignored;  ///< as GroupRules::ignore
  struct Welded {
    std::int64_t vertices = 0;         ///< joined to another: so many fewer there are
    std::int64_t collapsed_faces = 0;  ///< two corners became one: zero area in every frame
  };
  std::optional<Welded> welded;  ///< where asked for
  double seconds = 0;
};

/// From the counts alone (V3): violated, or clean where all that was expected was checked, or unknown.
[[nodiscard]] Verdict verdict_of(const SequenceReport& report);

/// Whether every frame that was asked for was gone through: a part that was stopped can be resumed.
[[nodiscard]] bool is_complete(const SequenceReport& report);

/// Throws io::Error on unreadable input: never a verdict on part of it; GroupRuleError on rules that do not fit;
/// std::invalid_argument on a range that is none of the sequence's frames.
[[nodiscard]] SequenceReport check_sequence(const io::SequenceReader& sequence, const SequenceOptions& options);

}  // namespace selvage::verify
