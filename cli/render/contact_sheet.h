// Several frames of a sequence on one picture, each with its number and time.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "cli/render/camera.h"
#include "io/format/png.h"
#include "io/sequence.h"

namespace selvage::cli {

struct SheetOptions {
  std::vector<std::size_t> frames;  ///< in the order of the tiles
  int columns = 4;
  int width = 1600;  ///< pixels of the whole sheet
  View view;
};

/// `count` frames spread evenly in time over the sequence, the first and the last among them; all if there are fewer.
[[nodiscard]] std::vector<std::size_t> spread_frames(const io::SequenceReader& sequence, std::size_t count);

/// All tiles show the same view, framed on the cloth of the chosen frames together, so that motion can be followed from
/// tile to tile. Calls progress(tiles done, total) every second or so; nothing is returned where it says false. Throws
/// io::Error, and UsageError where the sheet would be too small for its columns or have more than 10^8 pixels, beside
/// whose 9 bytes each (measured: 667 MB for 75 million) a mesh takes what it takes.
[[nodiscard]] std::optional<io::Picture> render_sheet(const io::SequenceReader& sequence, const SheetOptions& options,
                                                      const std::function<bool(std::size_t, std::size_t)>& progress);

}  // namespace selvage::cli
