// Frames of a stored sequence as the 3D view of a page.
#pragma once

#include <cstdint>
#include <vector>

#include "io/sequence.h"
#include "page/scene.h"

namespace selvage::cli {

/// The box of the cloth's vertices in these frames; of all vertices of faces where there is no cloth.
[[nodiscard]] page::Box stage_of(const io::SequenceReader& sequence, const std::vector<std::size_t>& frames);

/// Reads frame i and adds it, with its time where `has_times` (io::has_times(), once for a sequence), unless the scene
/// would exceed `byte_limit`: then the answer is false.
[[nodiscard]] bool add_frame(page::Scene& scene, const io::SequenceReader& sequence, bool has_times, std::size_t i,
                             std::size_t byte_limit);

}  // namespace selvage::cli
