#include "cli/answer/case_output.h"

#include <algorithm>

#include <fmt/format.h>

#include "fuzz/kept/case_file.h"
#include "fuzz/kept/overlap_case.h"
#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "verify/report/report.h"

namespace selvage::cli {
namespace {

constexpr const char* kCaseExtension = ".case";

std::string label(const verify::Violation& violation) {
  return fmt::format("{}-{}-{}-{}-{}", violation.motion ? "motion" : "frame", violation.frame,
                     verify::name_of(violation.event), violation.features[0], violation.features[1]);
}

std::string overlap_text(const verify::Violation& violation) {
  fuzz::OverlapCase kept;
  kept.seed = "verify:" + label(violation);
  kept.touches = violation.kind != "apart";  // a pair on which two deciders differ may be either
  for (std::size_t i = 0; i < 6; ++i) {
    kept.faces[i / 3][i % 3] = violation.vertices[i];
    kept.x[i / 3][i % 3] = violation.x_t0.at(i);
  }
  return format_overlap_case(kept);
}

std::string motion_text(const verify::Violation& violation, double min_distance) {
  const bool is_near = violation.kind == "near";
  fuzz::Case kept;
  kept.seed = "verify:" + label(violation);
  kept.query.kind = PairKind::kSelf;
  if (violation.event == verify::EventKind::kVf) kept.query.kind = PairKind::kVf;
  if (violation.event == verify::EventKind::kEe) kept.query.kind = PairKind::kEe;
  kept.query.options.tolerance = is_near ? min_distance : 0;
  const auto count = static_cast<std::size_t>(fuzz::point_count(kept.query.kind));
  for (std::size_t i = 0; i < count; ++i) {
    const verify::Point &p = violation.x_t0.at(i), &q = violation.x_t1.at(i);
    kept.query.x_t0[i] = {p[0], p[1], p[2]};
    kept.query.x_t1[i] = {q[0], q[1], q[2]};
  }
  kept.touches = fuzz::exact_motion(kept.query, verify::Detail::kDecision).touches;
  return format_case(kept);
}

}  // namespace

std::string case_name(const verify::Violation& violation) { return label(violation) + kCaseExtension; }

std::string case_text(const verify::Violation& violation, double min_distance) {
  return violation.event == verify::EventKind::kOverlap ? overlap_text(violation)
                                                        : motion_text(violation, min_distance);
}

void create_case_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) io::file_error(folder.string(), "create", error.value());
}

void require_no_cases(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != kCaseExtension) continue;
    throw io::Error(io::ErrorKind::kFile,
                    folder.string() + ": there are cases already; remove them or name another folder");
  }
}

void write_cases(const std::filesystem::path& folder, double min_distance, std::vector<verify::Violation>& violations) {
  create_case_folder(folder);
  for (verify::Violation& violation : violations) {
    const std::filesystem::path file = folder / case_name(violation);
    io::write_atomically(file, case_text(violation, min_distance));
    violation.case_file = file.string();
  }
}

}  // namespace selvage::cli
