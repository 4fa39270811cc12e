// A sequence as a page that plays it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "io/sequence.h"
#include "page/view_box.h"

namespace selvage::cli {

struct PlayerPage {
  std::string html;
  std::string summary;  ///< one line: which frames it shows, how they are rounded, how large it is
};

/// All frames, or where their meshes would be more than `byte_limit` every n-th one and the last, with the smallest n
/// that was found to fit. Calls progress(done, total) after every frame. Throws io::Error; kBadInput where not even the
/// first and the last frame fit.
[[nodiscard]] PlayerPage player_page(const std::string& title, const io::SequenceReader& sequence, page::UpAxis up,
                                     std::size_t byte_limit,
                                     const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace selvage::cli
