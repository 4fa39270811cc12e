#include "verify/report/merge.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "verify/smallest_gap.h"

namespace selvage::verify {
namespace {

std::string frames(std::int64_t first, std::int64_t end) {
  return "frames " + std::to_string(first) + " to " + std::to_string(end - 1);
}

/// Mesh files that are named one by one; not a folder or a file of all frames, which may be mounted under another name.
void require_same_files(const Part& a, const Part& b) {
  const auto name = [](const std::string& source) { return std::filesystem::path(source).filename(); };
  const std::vector<std::string>&of_a = a.parsed.context.sources, &of_b = b.parsed.context.sources;
  if (of_a.size() < 2 || of_a.size() != of_b.size()) return;  // the numbers of frames are compared
  const auto [in_a, in_b] = std::ranges::mismatch(of_a, of_b, {}, name, name);
  if (in_a == of_a.end()) return;
  throw MergeError(a.name + " and " + b.name + ": the files differ: " + *in_a + " and " + *in_b +
                   "; run every shard on the same files");
}

void require_same_check(const Part& a, const Part& b) {
  const auto require_same = [&](const std::string& what, const std::string& of_a, const std::string& of_b,
                                const char* remedy) {
    if (of_a == of_b) return;
    throw MergeError(a.name + " and " + b.name + ": " + what + " differ: " + of_a + " and " + of_b + "; " + remedy);
  };
  constexpr const char* kSameOptions = "run every shard with the same options";
  const ReportContext &of_a = a.parsed.context, &of_b = b.parsed.context;
  require_same("the programs", of_a.program, of_b.program, "run every shard with the same version");
  for (const auto& [name, value] : of_a.options) {
    const auto other = std::ranges::find(of_b.options, name, &std::pair<std::string, std::string>::first);
    const std::string value_b = other == of_b.options.end() ? "not said" : '"' + other->second + '"';
    require_same("the values of options." + name, '"' + value + '"', value_b, kSameOptions);
  }
  const SequenceReport &x = a.parsed.report, &y = b.parsed.report;
  require_same("the sequences", x.sequence + " of " + std::to_string(x.frame_count) + " frames",
               y.sequence + " of " + std::to_string(y.frame_count) + " frames", "run every shard on the same files");
  require_same("the values of --max-violations", std::to_string(x.max_violations), std::to_string(y.max_violations),
               kSameOptions);
  const bool same_shape = of_a.options.size() == of_b.options.size() && x.exempted.size() == y.exempted.size() &&
                          x.ignored.size() == y.ignored.size() && x.welded.has_value() == y.welded.has_value() &&
                          x.bodies_checked == y.bodies_checked && x.gap_searched == y.gap_searched &&
                          x.second_opinion == y.second_opinion && x.precision == y.precision;
  if (!same_shape) throw MergeError(a.name + " and " + b.name + ": what they report differs; " + kSameOptions);
}

MergeError missing(std::int64_t first, std::int64_t end) {
  return MergeError("no part holds " + frames(first, end) +
                    "; run that shard (selvage verify --shard i/N), and name its report too");
}

/// `b` begins where `a` ends.
void require_neighbours(const Part& a, const Part& b) {
  const SequenceReport &x = a.parsed.report, &y = b.parsed.report;
  if (y.first_frame < x.end_frame) {
    throw MergeError(a.name + " and " + b.name + ": both hold " +
                     frames(y.first_frame, std::min(x.end_frame, y.end_frame)) +
                     "; name shards of one N, and each once");
  }
  if (y.first_frame > x.end_frame) throw missing(x.end_frame, y.first_frame);
  if (!is_complete(x) || y.frame_crc32.empty()) return;  // then the verdict is unknown anyway
  const bool same_surface = x.surface_crc32.empty() || y.surface_crc32_before == x.surface_crc32.back();
  if (y.crc32_before != x.frame_crc32.back() || !same_surface) {
    throw MergeError(a.name + " and " + b.name + ": frame " + std::to_string(x.end_frame - 1) +
                     " changed between the two runs; run both shards again");
  }
}

void add(SequenceReport& sum, const SequenceReport& part) {
  sum.frames.checked += part.frames.checked;
  sum.frames.violated += part.frames.violated;
  sum.motions.checked += part.motions.checked;
  sum.motions.violated += part.motions.violated;
  sum.frames_expected += part.frames_expected;
  sum.motions_expected += part.motions_expected;
  sum.end_frame = part.end_frame;
  sum.frame_crc32.insert(sum.frame_crc32.end(), part.frame_crc32.begin(), part.frame_crc32.end());
  sum.surface_crc32.insert(sum.surface_crc32.end(), part.surface_crc32.begin(), part.surface_crc32.end());
  sum.pairs += part.pairs;
  sum.violations_total += part.violations_total;
  sum.violated.insert(sum.violated.end(), part.violated.begin(), part.violated.end());
  for (const Violation& violation : part.violations) {
    if (static_cast<std::int64_t>(sum.violations.size()) < sum.max_violations) sum.violations.push_back(violation);
  }
  for (const Violation& violation : part.disagreements) {
    if (static_cast<std::int64_t>(sum.disagreements.size()) < sum.max_violations)
      sum.disagreements.push_back(violation);
  }
  if (part.gap && (!sum.gap || is_smaller(*part.gap, *sum.gap))) sum.gap = part.gap;
  sum.unchecked.insert(sum.unchecked.end(), part.unchecked.begin(), part.unchecked.end());
  for (std::size_t i = 0; i < sum.exempted.size(); ++i) sum.exempted[i].pairs += part.exempted[i].pairs;
  sum.ignored = part.ignored;
  sum.welded = part.welded;
  sum.largest_coordinate = std::max(sum.largest_coordinate, part.largest_coordinate);
  sum.vertices = part.vertices;
  sum.faces = part.faces;
  sum.unreferenced_vertices = part.unreferenced_vertices;
  sum.body_faces = part.body_faces;
  sum.seconds += part.seconds;
}

/// Parts are of one sequence: what is noted of it is mostly said by all of them.
void add_notes(std::vector<std::string>& notes, const std::vector<std::string>& of_part) {
  std::ranges::copy_if(of_part, std::back_inserter(notes),
                       [&notes](const std::string& note) { return std::ranges::find(notes, note) == notes.end(); });
}

}  // namespace

ParsedReport merge(std::vector<Part> parts) {
  if (parts.empty()) throw MergeError("there is no report to merge; name those of selvage verify --shard");
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return std::pair(a.parsed.report.first_frame, a.name) < std::pair(b.parsed.report.first_frame, b.name);
  });
  for (std::size_t i = 1; i < parts.size(); ++i) {
    require_same_check(parts[0], parts[i]);
    require_same_files(parts[0], parts[i]);
    require_neighbours(parts[i - 1], parts[i]);
  }
  ParsedReport merged = std::move(parts.front().parsed);
  SequenceReport& report = merged.report;
  if (report.first_frame != 0) throw missing(0, report.first_frame);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    add(report, parts[i].parsed.report);
    merged.context.frame_names.merge(parts[i].parsed.context.frame_names);
    add_notes(merged.context.notes, parts[i].parsed.context.notes);
  }
  if (report.end_frame != report.frame_count) {
    throw missing(report.end_frame, report.frame_count);
  }
  const bool has_motions = report.motions_expected > 0;
  if (report.frames_expected != report.frame_count ||
      (has_motions && report.motions_expected != report.frame_count - 1)) {
    throw MergeError("the parts do not expect every frame and motion of the sequence; run every shard again");
  }
  report.verdict = verdict_of(report);
  return merged;
}

}  // namespace selvage::verify
