// The report of the checker as a page to look at.
#pragma once

#include <string>

#include "io/sequence.h"
#include "verify/report/report.h"

namespace selvage::cli {

struct ReportPageOptions {
  double min_distance = 0;               ///< of the check, for the cases
  std::size_t scene_bytes = 20'000'000;  ///< of the meshes in the page
};

/// One HTML file: verdict, counts, timeline, witnesses with their cases, and a 3D view of them. Without a sequence the
/// view shows the witnesses alone. Throws io::Error where a frame cannot be read.
[[nodiscard]] std::string report_page(const verify::SequenceReport& report, const verify::ReportContext& context,
                                      const io::SequenceReader* sequence, const ReportPageOptions& options);

}  // namespace selvage::cli
