// The 3D view as a part of a page: three.js (reduced, assets/three.js) and the scripts that draw with it.
#pragma once

#include "page/page.h"

namespace selvage::page {

enum class UpAxis { kY, kZ };

/// The element in which startViewer() of assets/viewer.js draws; `below` stands under the picture.
[[nodiscard]] Html view_box(UpAxis up, const Html& below);
/// What view_box() needs. Adds about 140 kB to the page.
void add_viewer(Page& page);

}  // namespace selvage::page
