// Draws one frame in software: a sun with shadows, a sky whose light is hidden by what stands around, two-sided cloth.
#pragma once

#include <functional>
#include <optional>

#include "cli/render/camera.h"
#include "cli/render/surface.h"
#include "io/format/png.h"

namespace selvage::cli {

/// Cloth is warm on its front (faces counter-clockwise) and cool on its back, so that a tangle shows at a glance;
/// bodies are grey. The points of `stage` fill the picture. Four samples a pixel; the same bits for any
/// number of threads. Drawn band by band, in memory that does not grow with the picture but for the picture itself.
/// Asks `go_on` before each band; nothing is returned where it says no.
[[nodiscard]] std::optional<io::Picture> render(const RenderSurface& surface, const View& view, const Stage& stage,
                                                int width, int height, const std::function<bool()>& go_on);

}  // namespace selvage::cli
