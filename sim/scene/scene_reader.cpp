#include "sim/scene/scene_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>

#include <fmt/format.h>

#include "io/file/atomic_file.h"
#include "io/file/fp_guard.h"
#include "sim/scene/contact_reader.h"
#include "sim/scene/scene_ranges.h"
#include "sim/scene/surface_reader.h"
#include "sim/scene/toml_table.h"

namespace selvage::sim {
namespace {

constexpr std::size_t kSceneByteLimit = std::size_t{1} << 24;  // a scene of 16 MB is a mesh in the wrong format
constexpr std::int64_t kMaxCopies = 10'000;                    // a million vertices of the smallest useful sheet
constexpr Range kDegrees{-1e6, 1e6};

constexpr std::int64_t kMaxRepeats = 100'000;  // more steps of a walk than a run has frames for
constexpr std::size_t kMaxKeys = 1'000'000;

constexpr const char* kBodyName = "body";  // where a body has none of its own

Pose read_pose(TomlTable& table) {
  return {table.vector("position_m", kCoordinate, Vec3::Zero()), table.vector("rotation_deg", kDegrees, Vec3::Zero())};
}

/// The keys of read_script().
void know_script(TomlTable& owner) { owner.know({"position_m", "rotation_deg", "key", "interpolation", "repeat"}); }

// The keys once more after themselves, `count` times in all.
void repeat_keys(std::size_t count, std::vector<PoseKey>& keys) {
  const std::size_t cycle = keys.size() - 1;
  const double period_s = keys.back().time_s - keys.front().time_s;
  keys.reserve(count * cycle + 1);
  for (std::size_t n = 1; n < count; ++n) {
    for (std::size_t i = 1; i <= cycle; ++i) keys.push_back({keys[i].time_s + double(n) * period_s, keys[i].pose});
  }
}

ScriptSpec read_script(TomlTable& owner) {
  ScriptSpec script;
  script.placement = read_pose(owner);
  std::vector<TomlTable> keys = owner.tables("key");
  constexpr std::array kInterpolations = {Interpolation::kLinear, Interpolation::kSmooth, Interpolation::kSpline};
  script.interpolation = kInterpolations[owner.choice("interpolation", {"linear", "smooth", "spline"})];
  for (TomlTable& key : keys) {
    key.know_only({"time_s", "position_m", "rotation_deg"});
    PoseKey read;
    read.time_s = key.number("time_s", kNotNegative);
    read.pose = read_pose(key);
    key.finish();
    if (!script.keys.empty() && read.time_s <= script.keys.back().time_s) {
      key.fail("time_s", "time_s must grow from key to key; sort the keys");
    }
    script.keys.push_back(read);
  }
  if (script.keys.empty()) script.keys.emplace_back();
  const auto repeats = static_cast<std::size_t>(owner.integer("repeat", 1, kMaxRepeats, 1));
  if (repeats > 1) {
    const Pose &first = script.keys.front().pose, &last = script.keys.back().pose;
    if (script.keys.size() < 2) owner.fail("repeat", "repeat needs at least two keys to play again");
    if (first.position_m != last.position_m || first.rotation_deg != last.rotation_deg) {
      owner.fail("repeat", "the last key must have the pose of the first, where the next round starts");
    }
    if (repeats * script.keys.size() > kMaxKeys) owner.fail("repeat", "more than a million keys; lower repeat");
    repeat_keys(repeats, script.keys);
  }
  return script;
}

std::vector<VertexId> sheet_edge(const SheetSpec& sheet, std::size_t edge) {
  std::vector<VertexId> vertices;
  const std::int32_t nx = sheet.nx, ny = sheet.ny;
  switch (edge) {
    case 0:
      for (std::int32_t i = 0; i < nx; ++i) vertices.push_back((ny - 1) * nx + i);
      break;
    case 1:
      for (std::int32_t i = 0; i < nx; ++i) vertices.push_back(i);
      break;
    case 2:
      for (std::int32_t j = 0; j < ny; ++j) vertices.push_back(j * nx);
      break;
    default:
      for (std::int32_t j = 0; j < ny; ++j) vertices.push_back(j * nx + nx - 1);
  }
  return vertices;
}

/// The one of `bodies` that `key` names; `else_do` ends what is said where there is none.
std::size_t read_body_index(TomlTable& table, std::string_view key, std::span<const std::string> bodies,
                            std::string_view else_do) {
  const std::string name = table.text(key);
  const auto found = std::ranges::find(bodies, name);
  if (found == bodies.end()) table.fail(key, fmt::format("no body \"{}\"{}", name, else_do));
  return static_cast<std::size_t>(found - bodies.begin());
}

void read_pin_motion(TomlTable& table, std::span<const std::string> bodies, PinSpec& pin) {
  if (table.has("body")) {
    for (const char* key : {"key", "position_m", "rotation_deg", "interpolation", "repeat"}) {
      if (table.has(key)) table.fail(key, fmt::format("a pin with a body moves as that does; leave out {}", key));
    }
    pin.body = read_body_index(table, "body", bodies, "; name one of the scene");
  }
  pin.script = read_script(table);
  const PoseKey& first = pin.script.keys.front();
  const auto is_zero = [](const Pose& pose) {
    return pose.position_m == Vec3::Zero() && pose.rotation_deg == Vec3::Zero();
  };
  if (first.time_s != 0 || !is_zero(first.pose) || !is_zero(pin.script.placement)) {
    table.fail("a pin starts where its vertices are; give it a first key with time_s = 0 alone");
  }
}

PinSpec read_pin(TomlTable table, const Surface& surface, std::span<const std::string> bodies) {
  table.know({"edge", "vertices", "body"});
  know_script(table);
  table.know_only({"release_s"});
  PinSpec pin;
  const auto* sheet = std::get_if<SheetSpec>(&surface);
  if (table.has("edge")) {
    if (sheet == nullptr) table.fail("edge", "only sheets have edges; list the vertices instead");
    if (table.has("vertices")) table.fail("edge", "edge and vertices exclude each other; keep one");
    pin.vertices = sheet_edge(*sheet, table.choice("edge", {"top", "bottom", "left", "right"}));
  } else {
    if (sheet != nullptr && !table.has("vertices")) {
      table.fail(
          "nothing says what it holds; add edge = \"top\", \"bottom\", \"left\" or \"right\", or vertices = [...]");
    }
    const std::int64_t last = sheet != nullptr ? std::int64_t{sheet->nx} * sheet->ny - 1 : INT32_MAX;
    for (const std::int64_t vertex : table.integers("vertices", 0, last)) {
      pin.vertices.push_back(static_cast<VertexId>(vertex));
    }
    pin.vertices_line = table.line("vertices");
    std::sort(pin.vertices.begin(), pin.vertices.end());
    if (std::adjacent_find(pin.vertices.begin(), pin.vertices.end()) != pin.vertices.end()) {
      table.fail("vertices", "a vertex is listed twice; remove one");
    }
  }
  read_pin_motion(table, bodies, pin);
  pin.release_s = table.number("release_s", kNotNegative, pin.release_s);
  table.finish();
  return pin;
}

std::string read_name(TomlTable& table, const std::string& fallback, std::set<std::string>& names) {
  std::string name = table.text("name", fallback);
  if (name.empty()) table.fail("name", "an empty name; give the part one, or leave the line out");
  if (!names.insert(name).second)
    table.fail("name", fmt::format("a second \"{}\"; give every part its own name", name));
  table.rename(fmt::format("\"{}\"", name));
  return name;
}

void note_stiffest(const TomlTable& table, ClothSpec& cloth) {
  const std::pair<double, const char*> stiffnesses[] = {{cloth.stretch_n_m, "stretch_n_m"},
                                                        {cloth.shear_n_m, "shear_n_m"},
                                                        {cloth.bend_n_m, "bend_n_m"},
                                                        {cloth.stabilize_n_m, "stabilize_n_m"}};
  cloth.stiffest_key =
      std::max_element(std::begin(stiffnesses), std::end(stiffnesses), [](const auto& a, const auto& b) {
        return a.first < b.first;
      })->second;
  cloth.stiffest_line = table.line(cloth.stiffest_key);
}

/// The cloth and its copies, each further along by `copy_offset_m`: stacks, and rows of hanging sheets.
std::vector<ClothSpec> read_cloth(TomlTable table, std::span<const std::string> bodies, std::set<std::string>& names,
                                  ContactReader& contacts) {
  table.know({"name", "copies", "copy_offset_m", "sheet", "garment", "mesh", "position_m", "rotation_deg",
              "velocity_m_s", "density_kg_m2", "masses", "stretch_n_m", "shear_n_m", "bend_n_m", "stabilize_n_m",
              "damping_ratio", "pin"});
  ContactReader::know(table);
  table.know_only({});
  ClothSpec cloth;
  cloth.name = read_name(table, "cloth", names);
  const std::int64_t copies = table.integer("copies", 1, kMaxCopies, 1);
  if (copies == 1 && table.has("copy_offset_m")) {
    table.fail("copy_offset_m", table.has("copies")
                                    ? "copies = 1 is this cloth alone; raise it, or remove copy_offset_m"
                                    : "there are no copies; give copies too");
  }
  const Vec3 offset = copies == 1 ? Vec3::Zero() : table.vector("copy_offset_m", kCoordinate);
  if (copies > 1 && offset.isZero(0)) {
    table.fail("copy_offset_m", fmt::format("copy_offset_m = [0, 0, 0] puts all {} copies at one place; move each "
                                            "along by its thickness or more",
                                            copies));
  }
  cloth.surface = read_cloth_surface(table);
  cloth.placement = read_pose(table);
  cloth.velocity_m_s = table.vector("velocity_m_s", {-1e6, 1e6}, Vec3::Zero());
  cloth.density_kg_m2 = table.number("density_kg_m2", kPositive);
  cloth.masses = table.choice("masses", {"equal", "area"}) == 0 ? ClothSpec::Masses::kEqual : ClothSpec::Masses::kArea;
  cloth.masses_line = table.line("masses");
  cloth.stretch_n_m = table.number("stretch_n_m", kPositive);
  cloth.shear_n_m = table.number("shear_n_m", kNotNegative, 0);
  if (cloth.shear_n_m > 0 && !std::holds_alternative<SheetSpec>(cloth.surface)) {
    table.fail("shear_n_m",
               "only sheets have shear springs; the edges of a mesh or garment resist shear by themselves");
  }
  cloth.bend_n_m = table.number("bend_n_m", kNotNegative, 0);
  cloth.stabilize_n_m = table.number("stabilize_n_m", kNotNegative, 0);
  note_stiffest(table, cloth);
  cloth.damping_ratio = table.number("damping_ratio", {0, 10}, 0);
  cloth.contact = contacts.read(table, io::Group::Role::kCloth);
  cloth.thickness_line = table.line("thickness_m");
  std::set<VertexId> pinned;
  for (TomlTable& pin_table : table.tables("pin")) {
    cloth.pins.push_back(read_pin(pin_table, cloth.surface, bodies));
    for (const VertexId vertex : cloth.pins.back().vertices) {
      if (!pinned.insert(vertex).second) {
        pin_table.fail(fmt::format("vertex {} is pinned already; a vertex has one pin", vertex));
      }
    }
  }
  table.finish();
  std::vector<ClothSpec> all(static_cast<std::size_t>(copies), cloth);
  for (std::int64_t i = 1; i < copies; ++i) {
    ClothSpec& copy = all[static_cast<std::size_t>(i)];
    copy.name = fmt::format("{} {}", cloth.name, i + 1);
    if (!names.insert(copy.name).second) {
      table.fail("copies", fmt::format("a copy and another part are both called \"{}\"; rename one", copy.name));
    }
    copy.placement.position_m += static_cast<double>(i) * offset;
    if (!std::ranges::all_of(copy.placement.position_m, [](double x) { return inside(x, kCoordinate); })) {
      table.fail("copy_offset_m", fmt::format("copy {} is at a coordinate beyond {} m; lower copies or copy_offset_m",
                                              i + 1, kCoordinate.upper));
    }
  }
  return all;
}

/// What is known of a body: before any cloth asks for its name.
void know_body(TomlTable& table) {
  table.know({"name", "sheet", "mesh", "sequence", "sphere", "ellipsoid", "capsule", "box", "parent"});
  know_script(table);
  ContactReader::know(table);
  table.know_only({});
}

// `earlier`: the bodies that the table may name as its parent; so there are no cycles.
BodySpec read_body(TomlTable table, std::span<const std::string> earlier, std::set<std::string>& names,
                   ContactReader& contacts) {
  BodySpec body;
  body.name = read_name(table, kBodyName, names);
  body.surface = read_body_surface(table);
  if (table.has("parent")) {
    body.parent = read_body_index(table, "parent", earlier, " above; name one, and put it before what hangs on it");
  }
  body.script = read_script(table);
  body.contact = contacts.read(table, io::Group::Role::kBody);
  table.finish();
  return body;
}

TimeSpec read_time(TomlTable table, Solver solver) {
  table.know_only({"frames_per_s", "frames", "duration_s", "dynamics_step_s", "max_step_s", "min_step_s"});
  TimeSpec time;
  time.frames_per_s = table.number("frames_per_s", {1e-6, 1e6}, time.frames_per_s);
  if (table.has("frames") && table.has("duration_s")) table.fail("give frames or duration_s, and not both");
  if (!table.has("frames") && !table.has("duration_s")) table.fail("nothing says how long; add frames or duration_s");
  if (table.has("frames")) {
    time.frame_count = table.integer("frames", 1, kMaxFrames);
  } else {
    const double frames = std::round(table.number("duration_s", kPositive) * time.frames_per_s);
    if (frames > kMaxFrames) table.fail("duration_s", "duration_s is more than 999,999 frames; shorten it");
    time.frame_count = std::max<std::int64_t>(1, static_cast<std::int64_t>(frames));
  }
  const double frame_s = 1 / time.frames_per_s;
  const auto step = [&](std::string_view key, double longest_s, const char* longest) -> std::optional<double> {
    if (!table.has(key)) return std::nullopt;
    const double step_s = table.number(key, {kLeastStepShare * frame_s, kPositive.upper});
    if (step_s > longest_s)
      table.fail(key, fmt::format("{} = {} is longer than {}, {} s; lower it", key, step_s, longest, longest_s));
    return step_s;
  };
  time.dynamics_step_s = step("dynamics_step_s", frame_s, "a frame");
  time.dynamics_step_line = table.line("dynamics_step_s");
  time.max_step_s = step("max_step_s", frame_s, "a frame");
  if (time.max_step_s) {
    time.min_step_s = step("min_step_s", *time.max_step_s, "max_step_s");
  } else if (solver == Solver::kImplicit && kLongestImplicit_s < frame_s) {
    time.min_step_s = step("min_step_s", kLongestImplicit_s, "the default max_step_s of solver = \"implicit\"");
  } else {
    time.min_step_s = step("min_step_s", frame_s, "a frame");
  }
  table.finish();
  return time;
}

CollisionOptions read_collision(TomlTable table) {
  CollisionOptions options;
  const ContactProperties contact = read_contact(table, contact_of(options));
  options.thickness_m = contact.thickness_m;
  options.tolerance_m = contact.tolerance_m;
  options.friction_static = contact.friction_static;
  options.friction_kinetic = contact.friction_kinetic;
  options.repulsion = table.boolean("repulsion", options.repulsion);
  options.repulsion_stiffness_n_m = table.number("repulsion_stiffness_n_m", kNotNegative, 0);
  options.overlap_fraction = table.number("overlap_fraction", {0, 1}, options.overlap_fraction);
  options.relaxation = table.number("relaxation", {0, 1, true}, options.relaxation);
  options.max_impulse_rounds =
      static_cast<std::int32_t>(table.integer("impulse_rounds", 0, 1000, options.max_impulse_rounds));
  options.max_zone_rounds = static_cast<std::int32_t>(table.integer("zone_rounds", 0, 1000, options.max_zone_rounds));
  options.precision = table.choice("precision", {"float64", "float32"}) == 0 ? CollisionOptions::Precision::kFloat64
                                                                             : CollisionOptions::Precision::kFloat32;
  table.finish();
  return options;
}

Scene read_root(TomlTable root) {
  root.know_only({"time", "gravity_m_s2", "drag_1_s", "quadratic_drag_1_m", "strain_limit", "strain_rate_limit",
                  "squeeze", "solver", "collision", "cloth", "body"});
  Scene scene;
  std::optional<TomlTable> time = root.table("time");
  if (!time) root.fail("the table [time] is missing; add it with frames = ...");
  scene.solver = root.choice("solver", {"explicit", "implicit"}) == 0 ? Solver::kExplicit : Solver::kImplicit;
  scene.time = read_time(std::move(*time), scene.solver);
  scene.gravity_m_s2 = root.vector("gravity_m_s2", {-1e6, 1e6}, Vec3::Zero());
  scene.drag_1_s = root.number("drag_1_s", {0, 1e6}, 0);
  scene.quadratic_drag_1_m = root.number("quadratic_drag_1_m", {0, 1e6}, 0);
  scene.strain.strain = root.number("strain_limit", {0, 0.9}, scene.strain.strain);
  scene.squeeze = root.choice("squeeze", {"stop", "yield"}) == 0 ? SqueezePolicy::kStop : SqueezePolicy::kYield;
  if (scene.solver == Solver::kExplicit) {
    scene.strain.strain_rate = root.number("strain_rate_limit", {0, 0.9}, scene.strain.strain_rate);
  } else if (root.number("strain_rate_limit", {0, 0.9}, 0) > 0) {
    root.fail("strain_rate_limit", "strain_rate_limit is for solver = \"explicit\" alone; leave it out, or make it 0");
  } else {
    scene.strain.strain_rate = 0;
  }
  std::optional<TomlTable> collision = root.table("collision");
  if (collision) {
    collision->know_only({"repulsion_stiffness_n_m", "contact_sweeps", "thickness_m", "tolerance_m", "repulsion",
                          "overlap_fraction", "relaxation", "friction_static", "friction_kinetic", "impulse_rounds",
                          "zone_rounds", "precision"});
  }
  const bool stiffness_given = collision && collision->has("repulsion_stiffness_n_m");
  if (collision) {
    if (scene.solver != Solver::kExplicit && collision->has("contact_sweeps")) {
      collision->fail("contact_sweeps", "contact_sweeps is for solver = \"explicit\" alone; leave it out");
    }
    scene.contact_sweeps = static_cast<std::int32_t>(collision->integer("contact_sweeps", 1, 100, 1));
    scene.collision = read_collision(std::move(*collision));
  }
  ContactReader contacts(scene.collision);
  std::set<std::string> names;
  std::vector<TomlTable> bodies = root.tables("body");
  std::vector<std::string> body_names;
  body_names.reserve(bodies.size());
  for (TomlTable& body : bodies) {
    know_body(body);
    body_names.push_back(body.text("name", kBodyName));
  }
  for (TomlTable& table : root.tables("cloth")) {
    for (ClothSpec& cloth : read_cloth(table, body_names, names, contacts)) scene.cloths.push_back(std::move(cloth));
  }
  if (scene.cloths.empty()) root.fail("no cloth; add a table [[cloth]]");
  for (TomlTable& body : bodies) {
    const auto earlier = std::span(body_names).first(scene.bodies.size());
    scene.bodies.push_back(read_body(body, earlier, names, contacts));
  }
  root.finish();
  if (!stiffness_given) {
    // Paper, 7.2: "matching the stiffness of the stretch springs in the cloth gave good results".
    for (const ClothSpec& cloth : scene.cloths) {
      scene.collision.repulsion_stiffness_n_m = std::max(scene.collision.repulsion_stiffness_n_m, cloth.stretch_n_m);
    }
  }
  return scene;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& name, Quality quality) {
  const io::FpGuard guard;
  try {
    const toml::table table = toml::parse(text);
    const TomlSource source{name, quality};
    Scene scene = read_root(TomlTable(table, "scene", source));
    scene.file = name;
    scene.quality = quality;
    return scene;
  } catch (const toml::parse_error& error) {
    throw io::Error(io::ErrorKind::kBadInput, fmt::format("{}:{}: {}; correct the TOML syntax", name,
                                                          error.source().begin.line, error.description()));
  } catch (const TomlConfusion& error) {
    throw io::Error(io::ErrorKind::kBadInput, fmt::format("{}: {}; correct the TOML syntax", name, error.what()));
  }
}

Scene read_scene(const std::filesystem::path& file, Quality quality) {
  return parse_scene(io::read_file(file, kSceneByteLimit), file.string(), quality);
}

}  // namespace selvage::sim
