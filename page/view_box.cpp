#include "page/view_box.h"

#include "page/assets.h"
#include "page/packed.h"

namespace selvage::page {

Html view_box(UpAxis up, const Html& below) {
  const auto choice = [&](UpAxis axis, std::string_view name) {
    return axis == up ? element("option", {{"selected", ""}, {"value", name}}, text(name))
                      : element("option", {{"value", name}}, text(name));
  };
  const Html canvas = element(
      "canvas",
      {{"tabindex", "0"},
       {"aria-label", "3D view: arrow keys turn it, plus and minus go nearer and farther, 0 shows the whole cloth"}},
      {});
  const Html bar =
      element("button", {{"type", "button"}, {"data-do", "overview"}}, text("Whole cloth")) +
      element("label", {}, Html{"<input type=\"checkbox\" data-do=\"edges\"> "} + text("Edges")) +
      element("label", {},
              text("Up ") + element("select", {{"data-do", "up"}}, choice(UpAxis::kZ, "z") + choice(UpAxis::kY, "y"))) +
      element("span", {{"class", "quiet"}}, text("Drag turns, shift-drag moves, the wheel goes nearer."));
  return element(
      "div", {{"class", "view"}},
      element("div", {{"class", "picture"}}, canvas + element("p", {{"class", "message"}, {"role", "status"}}, {})) +
          Html{"\n"} + element("div", {{"class", "bar"}}, bar) + Html{"\n"} + below);
}

void add_viewer(Page& page) {
  page.add_packed("three", packed(asset("three.js")));
  for (const char* script :
       {"unpack.js", "scene.js", "vector.js", "materials.js", "camera.js", "pair.js", "viewer.js"}) {
    page.add_script(asset(script));
  }
}

}  // namespace selvage::page
