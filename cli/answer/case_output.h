// Violations as case files that `selvage replay` explains.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "verify/check.h"

namespace selvage::cli {

/// "motion-12-vf-3-0.case": unique in a report.
[[nodiscard]] std::string case_name(const verify::Violation& violation);
/// The text of its case: a motion, a frame as a motion at rest, or two triangles. `min_distance` is that of the check.
[[nodiscard]] std::string case_text(const verify::Violation& violation, double min_distance);
/// Makes the folder if it is absent. Throws io::Error.
void create_case_folder(const std::filesystem::path& folder);
/// Throws io::Error where the folder holds cases: those of another run could not be told from those of this one.
void require_no_cases(const std::filesystem::path& folder);
/// Writes one file a violation into `folder`, which is made if it is absent, and notes its name in the violation.
/// Throws io::Error.
void write_cases(const std::filesystem::path& folder, double min_distance, std::vector<verify::Violation>& violations);

}  // namespace selvage::cli
