// Which frames the page of a report shows: those with witnesses first, then some of the others, as far as they fit.
#pragma once

#include <vector>

#include "io/sequence.h"
#include "page/scene.h"
#include "verify/check.h"

namespace selvage::cli {

/// In the order of the report's witnesses (of a motion both ends), then frames spread over the part that was checked,
/// so that a clean sequence can be looked at too. Each once.
[[nodiscard]] std::vector<std::size_t> wanted_frames(const verify::SequenceReport& report);

struct ReportScene {
  page::Scene scene;
  std::size_t wanted = 0;  ///< how many frames there would be without the limit
};
/// The wanted frames that fit into `byte_limit`, each independent of the others. Without a sequence there are none, and
/// the view is about the witnesses.
[[nodiscard]] ReportScene report_scene(const verify::SequenceReport& report, const io::SequenceReader* sequence,
                                       std::size_t byte_limit);

}  // namespace selvage::cli
