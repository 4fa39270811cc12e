#include "fuzz/draw/random_scene.h"

#include <array>
#include <cmath>

#include "fuzz/base/case_text.h"

namespace selvage::fuzz {
namespace {

/// Lengths are in units of the cloth's side, so that one factor scales the scene.
class SceneText {
 public:
  explicit SceneText(ChoiceSource& source) : source_(source), unit_m_(std::ldexp(1.0, source.range(0, 4) - 3)) {
    if (source.coin()) {
      for (double& coordinate : offset_m_) {
        const auto multiple = static_cast<double>(source.zigzag(2));
        coordinate = std::ldexp(multiple, source.range(0, 12));
      }
    }
  }

  void line(const std::string& text) { text_ += text + "\n"; }
  void value(std::string_view key, double x) { line(std::string(key) + " = " + decimal(x)); }
  void length(std::string_view key, double x) { value(key, x * unit_m_); }
  void place(std::string_view key, double x, double y, double z) {
    line(std::string(key) + " = " +
         triple(x * unit_m_ + offset_m_[0], y * unit_m_ + offset_m_[1], z * unit_m_ + offset_m_[2]));
  }
  /// Up to `size` away from the middle.
  void place_beside(std::string_view key, double size, double z) {
    const double y = jitter(size), x = jitter(size);
    place(key, x, y, z);
  }
  void speed(double x, double y, double z) { line("velocity_m_s = " + triple(x * unit_m_, y * unit_m_, z * unit_m_)); }

  void head() {
    if (!source_.one_in(8)) value("drag_1_s", 0.1 * source_.range(0, 5));
    if (!source_.one_in(4)) line("gravity_m_s2 = " + triple(0, 0, -9.81 * unit_m_));
    if (source_.coin()) line("squeeze = \"yield\"");
    if (source_.one_in(4)) line("strain_limit = 0");
    line("[time]");
    value("frames_per_s", 30);
    line("frames = 40");
    value("min_step_s", std::ldexp(1.0, -source_.range(6, 9)));
    line("[collision]");
    length("thickness_m", thickness());
    length("tolerance_m", thickness() * std::ldexp(1.0, -source_.range(1, 16)));
    if (source_.coin()) value("friction_static", 0.1 * source_.range(1, 9));
    if (source_.one_in(4)) line("repulsion = false");
    if (source_.one_in(3)) line("contact_sweeps = " + std::to_string(source_.range(2, 5)));
    line("impulse_rounds = " + std::to_string(source_.range(0, 6)));
    line("zone_rounds = " + std::to_string(source_.range(0, 6)));
    if (source_.one_in(3)) line("precision = \"float32\"");
  }

  /// A square of side 1 (times `side`) at the height z, moving along it.
  void cloth(int cells, double side, double x, double y, double z, double speed_z) {
    line("[[cloth]]");
    line("name = \"cloth " + std::to_string(++cloths_) + "\"");
    const std::string n = std::to_string(cells + 1);
    line("sheet = {nx = " + n + ", ny = " + n + ", width_m = " + decimal(side * unit_m_) +
         ", height_m = " + decimal(side * unit_m_) + "}");
    place("position_m", x, y, z);
    const double speed_y = jitter(2), speed_x = jitter(2);
    speed(speed_x, speed_y, speed_z);
    value("density_kg_m2", 0.2);
    value("stretch_n_m", 10 * source_.range(1, 6));
    if (source_.coin()) value("shear_n_m", 4);
    if (source_.coin()) value("bend_n_m", 0.2);
    if (source_.coin()) value("damping_ratio", 0.1);
    contact();
  }

  void body_shape(double size) {
    line("[[body]]");
    line("name = \"body " + std::to_string(++bodies_) + "\"");
    if (source_.coin()) {
      line("box = {size_m = " + triple(size * unit_m_, size * unit_m_, size * unit_m_) + "}");
    } else {
      line("sphere = {radius_m = " + decimal(size / 2 * unit_m_) +
           ", subdivisions = " + std::to_string(source_.range(0, 2)) + "}");
    }
    contact();
  }
  /// Sometimes properties of the part's own. Thicknesses are at least the scene's, as any tolerance may meet any of
  /// them.
  void contact() {
    if (!source_.one_in(3)) return;
    length("thickness_m", thickness() * std::ldexp(1.0, source_.range(0, 2)));
    length("tolerance_m", thickness() * std::ldexp(1.0, -source_.range(1, 16)));
    value("friction_static", 0.1 * source_.range(0, 9));
  }
  void key(double time_s, double x, double y, double z) {
    line("[[body.key]]");
    value("time_s", time_s);
    place("position_m", x, y, z);
  }
  void key_beside(double time_s, double size, double z) {
    const double y = jitter(size), x = jitter(size);
    key(time_s, x, y, z);
  }
  void ground(double z) {
    line("[[body]]");
    line("name = \"ground\"");
    line("sheet = {nx = 2, ny = 2, width_m = " + decimal(6 * unit_m_) + ", height_m = " + decimal(6 * unit_m_) + "}");
    place_beside("position_m", 0.1, z);
  }

  double jitter(double size) { return size * source_.signed_real(); }
  [[nodiscard]] static double thickness() { return 1.0 / 128; }
  ChoiceSource& source() { return source_; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  /// TOML has no hex floats; 17 digits are exact.
  static std::string decimal(double x) {
    std::array<char, 40> buffer{};
    const int length = std::snprintf(buffer.data(), buffer.size(), "%.17g", x);
    std::string text(buffer.data(), static_cast<std::size_t>(length));
    const bool is_integer = text.find_first_of(".e") == std::string::npos;
    return is_integer ? text + ".0" : text;
  }
  static std::string triple(double x, double y, double z) {
    return "[" + decimal(x) + ", " + decimal(y) + ", " + decimal(z) + "]";
  }

  ChoiceSource& source_;
  double unit_m_;
  std::array<double, 3> offset_m_{};
  std::string text_;
  int cloths_ = 0, bodies_ = 0;
};

void fall(SceneText& scene) {
  const double speed = scene.jitter(8);
  scene.cloth(scene.source().range(2, 9), 1, 0, 0, 0.6, speed);
  scene.body_shape(0.5);
  scene.place_beside("position_m", 0.3, 0);
  if (scene.source().coin()) scene.ground(-0.4);
}

void stack(SceneText& scene) {
  const int layers = scene.source().range(2, 5);
  for (int layer = 0; layer < layers; ++layer) {
    const double speed = scene.jitter(6), y = scene.jitter(0.1), x = scene.jitter(0.1);
    scene.cloth(scene.source().range(2, 5), 1, x, y, 0.05 + 0.02 * layer, speed);
  }
  scene.ground(0);
}

void pinch(SceneText& scene) {
  scene.cloth(scene.source().range(3, 7), 1, 0, 0, 0, 0);
  const double last_s = 0.1 * scene.source().range(2, 10), overlap = scene.jitter(0.2);
  for (const double side : {-1.0, 1.0}) {
    scene.body_shape(0.6);
    scene.key_beside(0, 0.1, side * 0.5);
    scene.key_beside(last_s, 0.2, side * (0.3 + overlap));
  }
}

void fling(SceneText& scene) {
  const double speed = scene.jitter(4);
  scene.cloth(scene.source().range(3, 9), 1, 0, 0, 0.5, speed);
  scene.line("[[cloth.pin]]");
  scene.line(scene.source().coin() ? "edge = \"top\"" : "edge = \"left\"");
  if (scene.source().coin()) scene.value("release_s", 0.3);
  const double reach = std::ldexp(1.0, scene.source().range(0, 4) - 3);
  scene.line("[[cloth.pin.key]]\ntime_s = 0.0");
  for (int i = 1; i <= 3; ++i) {
    scene.line("[[cloth.pin.key]]");
    scene.value("time_s", 0.15 * i);
    const double y = scene.jitter(reach), x = scene.jitter(reach);
    const std::string z = i % 2 == 1 ? "-" : "";
    scene.line("position_m = [" + std::to_string(x) + ", " + std::to_string(y) + ", " + z + std::to_string(reach) +
               "]");
  }
  if (scene.source().coin()) scene.ground(-0.7);
}

void crowd(SceneText& scene) {
  const int count = scene.source().range(2, 4);
  for (int i = 0; i < count; ++i) {
    const double speed = scene.jitter(60), y = scene.jitter(0.2), x = scene.jitter(0.2);
    scene.cloth(scene.source().range(1, 3), 0.4, x, y, 0.3 * i, speed);
  }
  const int bodies = scene.source().range(1, 2);
  for (int i = 0; i < bodies; ++i) {
    scene.body_shape(0.2);
    const double side = i == 0 ? -1 : 1;
    scene.key(0, side, 0, 0.15 + 0.3 * i);
    const double z = 0.15 + 0.3 * i + scene.jitter(0.5), y = scene.jitter(0.5);
    scene.key(0.05 * scene.source().range(1, 12), -side, y, z);
  }
}

void carry(SceneText& scene) {
  scene.cloth(scene.source().range(2, 7), 1, 0, 0, 0.6, 0);
  scene.line("[[cloth.pin]]\nbody = \"body 1\"");
  scene.line(scene.source().coin() ? "edge = \"right\"" : "vertices = [0, 1]");
  if (scene.source().coin()) scene.value("release_s", 0.5);
  scene.body_shape(0.5);
  const double first_z = scene.source().coin() ? 1 : 0.2;
  scene.key_beside(0, 0.2, first_z);
  scene.line("rotation_deg = [" + std::to_string(scene.jitter(90)) + ", 0.0, 0.0]");
  const double z = scene.jitter(1), y = scene.jitter(1), x = scene.jitter(1);
  scene.key(0.1 * scene.source().range(2, 10), x, y, z);
  scene.line("rotation_deg = [0.0, " + std::to_string(scene.jitter(180)) + ", 0.0]");
  scene.body_shape(0.3);
  scene.place_beside("position_m", 0.5, -0.3);
  if (scene.source().coin()) scene.ground(-0.7);
}

struct SceneClass {
  std::string_view name;
  void (*make)(SceneText&);
};
constexpr std::array<SceneClass, 6> kSceneClasses{
    {{"fall", fall}, {"stack", stack}, {"pinch", pinch}, {"fling", fling}, {"crowd", crowd}, {"carry", carry}}};

}  // namespace

const std::vector<std::string_view>& scene_classes() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    all.reserve(kSceneClasses.size());
    for (const SceneClass& one : kSceneClasses) all.push_back(one.name);
    return all;
  }();
  return names;
}

std::string random_scene(std::string_view scene_class, ChoiceSource& source) {
  SceneText scene(source);
  scene.head();
  for (const SceneClass& one : kSceneClasses) {
    if (one.name == scene_class) one.make(scene);
  }
  return scene.text();
}

}  // namespace selvage::fuzz
