#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "io/fail.h"
#include "io/format/polygon.h"
#include "io/mesh_reader.h"
#include "kernel/fp_env.h"
#include "sim/bodies/body_sequence.h"
#include "sim/bodies/collinear_faces.h"
#include "sim/bodies/joined_faces.h"
#include "sim/bodies/mesh_shape.h"
#include "sim/bodies/one_place.h"
#include "sim/cloth.h"
#include "sim/scene/scene_ranges.h"
#include "sim/step_clock.h"

namespace selvage::sim {
namespace {

Shape make_shape(const SheetSpec& sheet, const Scene&) {
  return make_sheet(sheet.nx, sheet.ny, sheet.width_m, sheet.height_m);
}
Shape make_shape(const SphereSpec& sphere, const Scene&) { return make_sphere(sphere.radius_m, sphere.subdivisions); }
Shape make_shape(const EllipsoidSpec& ellipsoid, const Scene&) {
  return make_ellipsoid(ellipsoid.size_m, ellipsoid.subdivisions);
}
Shape make_shape(const CapsuleSpec& capsule, const Scene&) {
  return make_capsule(capsule.end_m, capsule.radius_m, capsule.end_radius_m, capsule.segments);
}
Shape make_shape(const BoxSpec& box, const Scene&) { return make_box(box.size_m, box.cells); }
Shape make_shape(const GarmentSpec& garment, const Scene& scene) {
  try {
    return make_garment(garment);
  } catch (const GarmentError& error) {
    io::bad_input_at_line(scene.file.string(), garment.sleeves_line, error.what());
  }
}

Shape make_shape(const MeshSpec& mesh, const Scene& scene) {
  return read_for_line(scene.file, mesh.line, "mesh", [&]() -> Shape {
    const io::MeshData data = io::read_mesh(scene.file.parent_path() / mesh.file);
    return {scaled_positions(data.points, mesh.scale, mesh.file.string()), data.triangles,
            io::split_remark(mesh.file.string(), data.split_polygons)};
  });
}

/// Thicknesses in an edge of the median length. Within two thicknesses of a vertex of a flat grid there are some 80
/// pairs times the square of this: at 4 each costs 0.6 MB, and a step that is tried 1 ms of the processor (40 x 40
/// vertices, one thread). Nor can cloth as thick fold: its pairs repel below their distance at rest.
constexpr double kMaxThicknessInEdges = 4;

double median_edge_m(const Mesh& mesh, const Positions& x) {
  std::vector<double> lengths_m;
  for (const auto& [a, b] : mesh.edges) lengths_m.push_back((x.row(a) - x.row(b)).norm());
  const auto middle = lengths_m.begin() + std::ssize(lengths_m) / 2;
  std::ranges::nth_element(lengths_m, middle);
  return *middle;
}

/// The rows that faces hold, or nothing where all are. Exporters leave vertices far away for "none", where no surface
/// is that cloth could meet.
std::optional<std::vector<Eigen::Index>> rows_in_faces(const Shape& shape) {
  const std::vector<std::uint8_t> is_held =
      vertices_in_faces(shape.triangles, static_cast<std::size_t>(shape.x.rows()));
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < shape.x.rows(); ++i) {
    if (is_held[static_cast<std::size_t>(i)] != 0) rows.push_back(i);
  }
  if (std::ssize(rows) == shape.x.rows()) return std::nullopt;
  return rows;
}

// Collects parts into one vertex and one face list.
class WorldBuilder {
 public:
  explicit WorldBuilder(const Scene& scene) : scene_(scene) {}

  void add_cloth(const ClothSpec& spec) {
    const Shape rest = shape_of(spec.surface);
    const std::vector<double> mass_kg = cloth_masses(spec, rest);
    require_masses(spec, mass_kg);
    const VertexId begin = add_part(spec.name, io::Group::Role::kCloth, rest, place(spec.placement, rest.x));
    add_contact(spec.contact);
    if (scene_.collision.repulsion) add_rest_pairs(spec, rest, begin);
    v_.bottomRows(rest.x.rows()).rowwise() = spec.velocity_m_s.transpose();
    for (const double mass : mass_kg) inverse_mass_.push_back(1 / mass);
    for (Spring spring : make_springs(spec, rest, mass_kg)) {
      spring.a += begin;
      spring.b += begin;
      springs_.push_back(spring);
    }
    for (Stabilizer stabilizer : make_stabilizers(spec, rest, mass_kg)) {
      for (VertexId& vertex : stabilizer.vertices) vertex += begin;
      stabilizers_.push_back(stabilizer);
    }
    cloths_.push_back({begin, static_cast<VertexId>(rest.x.rows())});
  }

  void add_body(const BodySpec& spec) {
    RigidPath path(spec.script.keys, spec.script.interpolation);
    linkages_.push_back(spec.parent ? Linkage(spec.script.placement, std::move(path), linkages_.at(*spec.parent))
                                    : Linkage(spec.script.placement, std::move(path)));
    joined_.emplace_back();
    if (const auto* animated = std::get_if<SequenceSpec>(&spec.surface)) {
      const auto sequence = std::make_shared<const BodySequence>(*animated, scene_.file);
      Shape shape = sequence->first();
      join(shape, sequence->one_place(), true);
      add_collider(spec, shape, Collider::Animated{sequence, linkages_.back()});
    } else {
      const auto& surface = std::get<Surface>(spec.surface);
      Shape shape = shape_of(surface);
      if (std::holds_alternative<MeshSpec>(surface)) {
        OnePlace place;
        place.narrow(shape.x);
        join(shape, place, false);
      }
      add_collider(spec, shape, Collider::Rigid{shape.x, linkages_.back()});
    }
  }

  /// Of cloth number `cloth` of the scene, after all bodies.
  void add_pins(std::size_t cloth) {
    const ClothSpec& spec = scene_.cloths[cloth];
    for (std::size_t n = 0; n < spec.pins.size(); ++n) {
      add_pin(fmt::format("{} pin {}", spec.name, n), spec.pins[n], cloths_[cloth]);
    }
  }

  World take(std::int32_t cloth_vertex_count) {
    World world;
    world.triangles = std::move(triangles_);
    world.groups = std::move(groups_);
    world.cloth_vertex_count = cloth_vertex_count;
    world.inverse_mass = std::move(inverse_mass_);
    world.springs = SpringSystem(std::move(springs_), cloth_vertex_count);
    world.stabilizers = StabilizerSystem(std::move(stabilizers_), cloth_vertex_count);
    world.colliders = std::move(bodies_);
    world.contacts = take_contacts();
    world.joined = std::move(joined_);
    world.remarks = std::move(remarks_);
    world.body_count = static_cast<std::int32_t>(world.colliders.size());
    std::move(pins_.begin(), pins_.end(), std::back_inserter(world.colliders));
    for (const Collider& collider : world.colliders) world.deforms.push_back(collider.deforms() ? 1 : 0);
    world.mesh = make_mesh(vertex_count(), world.triangles);
    world.stable_step_s = stable_step_s(world.springs, world.inverse_mass, world.stabilizers);
    const Precision precision = scene_.collision.precision;
    world.x_t0 = rounded(std::move(x_), precision);
    world.v_t0 = std::move(v_);
    for (const Collider& collider : world.colliders) collider.place_at(0, precision, world.x_t0);
    return world;
  }
  [[nodiscard]] VertexId vertex_count() const { return static_cast<VertexId>(v_.rows()); }

 private:
  void require_masses(const ClothSpec& spec, const std::vector<double>& mass_kg) const {
    const double least_kg = *std::ranges::min_element(mass_kg);
    if (std::isfinite(1 / least_kg)) return;  // which is what is simulated with
    if (least_kg > 0) {
      io::bad_input_at_line(scene_.file.string(), spec.masses_line,
                            fmt::format("\"{}\" has a vertex of {:g} kg, which is too little to be divided by; raise "
                                        "density_kg_m2",
                                        spec.name, least_kg));
    }
    const bool has_any = std::ranges::any_of(mass_kg, [](double mass) { return mass > 0; });
    io::bad_input_at_line(
        scene_.file.string(), spec.masses_line,
        fmt::format("\"{}\" has {}", spec.name,
                    has_any
                        ? "a vertex without mass, in no face or only in faces without area; remove it from the mesh "
                          "or use masses = \"equal\""
                        : "no mass, as its area times density_kg_m2 is zero; give its faces an area, or raise "
                          "density_kg_m2"));
  }

  [[nodiscard]] Shape shape_of(const Surface& surface) const {
    return std::visit([&](const auto& spec) { return make_shape(spec, scene_); }, surface);
  }

  VertexId add_part(const std::string& name, io::Group::Role role, const Shape& shape, const Positions& placed) {
    const auto begin = static_cast<VertexId>(x_.rows());
    const auto face_begin = static_cast<FaceId>(triangles_.size());
    if (!shape.remark.empty() && std::ranges::find(remarks_, shape.remark) == remarks_.end()) {
      remarks_.push_back(shape.remark);
    }
    for (const auto& t : shape.triangles) triangles_.push_back({t[0] + begin, t[1] + begin, t[2] + begin});
    groups_.push_back({name, role, face_begin, static_cast<FaceId>(triangles_.size())});
    x_.conservativeResize(begin + placed.rows(), 3);
    x_.bottomRows(placed.rows()) = placed;
    v_.conservativeResize(x_.rows(), 3);
    v_.bottomRows(placed.rows()).setZero();
    return begin;
  }

  // Of the vertices that have been added and have none. Number 0 is the scene's.
  void add_contact(const std::optional<ContactProperties>& own) {
    std::vector<ContactProperties>& known = contacts_.properties;
    if (known.empty()) known.push_back(contact_of(scene_.collision));
    const auto found = std::find(known.begin(), known.end(), own.value_or(known.front()));
    const auto number = static_cast<std::int32_t>(found - known.begin());
    if (found == known.end()) known.push_back(*own);
    contacts_.surface_of_vertex.resize(static_cast<std::size_t>(x_.rows()), number);
  }

  ContactSurfaces take_contacts() {
    ContactSurfaces contacts;
    if (contacts_.properties.size() > 1) contacts = std::move(contacts_);
    contacts.rest_pairs = std::move(rest_pairs_);
    return contacts;
  }

  // Of the cloth that was added last, from `begin` on. Edges are numbered by their larger vertex, so that those of a
  // part follow one another as in a mesh of its own.
  void add_rest_pairs(const ClothSpec& spec, const Shape& rest, VertexId begin) {
    const Mesh mesh = make_mesh(static_cast<VertexId>(rest.x.rows()), rest.triangles);
    const double thickness_m = spec.contact.value_or(contact_of(scene_.collision)).thickness_m;
    const double edge_m = median_edge_m(mesh, rest.x);
    if (thickness_m > kMaxThicknessInEdges * edge_m) {
      io::bad_input_at_line(
          scene_.file.string(), spec.thickness_line,
          fmt::format("\"{}\" is {:g} m thick, more than {:g} of its edges of {:g} m (the median): its own neighbours "
                      "would be its contacts; give it a thickness_m of at most {:g}, or correct the scale of its mesh",
                      spec.name, thickness_m, kMaxThicknessInEdges, edge_m, kMaxThicknessInEdges * edge_m));
    }
    const auto face_begin = static_cast<FaceId>(triangles_.size() - rest.triangles.size());
    for (RestPair pair : find_rest_pairs(mesh, rest.x, thickness_m)) {
      pair.first += pair.kind == PairKind::kEe ? edge_begin_ : begin;
      pair.second += pair.kind == PairKind::kEe ? edge_begin_ : face_begin;
      rest_pairs_.push_back(pair);
    }
    edge_begin_ += static_cast<EdgeId>(mesh.edges.size());
  }

  // The faces of the body that is added: of a file, which may hold its surface in pieces. What lies on a line does not
  // stay there where vertices move against each other.
  void join(Shape& shape, const OnePlace& place, bool deforms) {
    JoinedFaces joined = join_faces(shape.triangles, place.first());
    joined_.back() = {joined.joined_vertices, joined.left_out};
    shape.triangles = std::move(joined.triangles);
    if (deforms) return;
    SplitFaces split = split_at_collinear_corners(std::move(shape.triangles), shape.x);
    joined_.back().faces_without_area += split.resolved;
    shape.triangles = std::move(split.triangles);
  }

  void add_collider(const BodySpec& spec, const Shape& shape, Collider::Motion motion) {
    std::vector<VertexId> vertices(static_cast<std::size_t>(shape.x.rows()));
    std::iota(vertices.begin(), vertices.end(), vertex_count());
    bodies_.emplace_back(spec.name, std::move(vertices), std::move(motion), Collider::kNeverReleased_s,
                         rows_in_faces(shape));
    add_part(spec.name, io::Group::Role::kBody, shape, bodies_.back().placed_at(0, Precision::kFloat64, x_));
    add_contact(spec.contact);
    inverse_mass_.resize(static_cast<std::size_t>(x_.rows()), 0);
  }

  struct ClothRows {
    VertexId begin, count;
  };

  void add_pin(const std::string& name, const PinSpec& spec, const ClothRows& cloth) {
    if (spec.vertices.back() >= cloth.count) {
      io::bad_input_at_line(scene_.file.string(), spec.vertices_line,
                            fmt::format("{} holds vertex {}, but its cloth has {}, numbered from 0; correct the list",
                                        name, spec.vertices.back(), cloth.count));
    }
    std::vector<VertexId> vertices;
    for (const VertexId vertex : spec.vertices) vertices.push_back(cloth.begin + vertex);
    Collider::Motion motion = spec.body ? carried_by(*spec.body, vertices) : scripted(spec.script, vertices);
    pins_.emplace_back(name, std::move(vertices), std::move(motion), spec.release_s);
  }

  [[nodiscard]] Collider::Motion carried_by(std::size_t body, const std::vector<VertexId>& vertices) const {
    const Collider& carrier = bodies_[body];
    // Where the bodies will stand. How a face of 3 mm has turned is known to 1 in 50 by float32 at a kilometre, and
    // what hung 0.3 m from one that had not moved began 9 mm away from where it was put.
    const Precision precision = scene_.collision.precision;
    Attachment attachment(rounded(x_(vertices, Eigen::all), precision), faces_of(body),
                          carrier.placed_at(0, precision, x_));
    return Collider::Carried{std::move(attachment), body, carrier.vertices().front()};
  }

  /// Of its own vertices, numbered from 0.
  [[nodiscard]] io::Triangles faces_of(std::size_t body) const {
    const io::Group& group = groups_[scene_.cloths.size() + body];
    const VertexId begin = bodies_[body].vertices().front();
    io::Triangles faces(triangles_.begin() + group.face_begin, triangles_.begin() + group.face_end);
    for (auto& face : faces) face = {face[0] - begin, face[1] - begin, face[2] - begin};
    return faces;
  }

  // About the mean of the vertices.
  [[nodiscard]] Collider::Motion scripted(const ScriptSpec& script, const std::vector<VertexId>& vertices) const {
    Vec3 mean = Vec3::Zero();
    for (const VertexId vertex : vertices) mean += x_.row(vertex).transpose() / double(vertices.size());
    Positions local = x_(vertices, Eigen::all);
    local.rowwise() -= mean.transpose();
    return Collider::Rigid{std::move(local),
                           Linkage({mean, Vec3::Zero()}, RigidPath(script.keys, script.interpolation))};
  }

  const Scene& scene_;
  io::Triangles triangles_;
  std::vector<io::Group> groups_;
  Positions x_{0, 3}, v_{0, 3};
  std::vector<double> inverse_mass_;
  std::vector<Spring> springs_;
  std::vector<Stabilizer> stabilizers_;
  std::vector<ClothRows> cloths_;
  std::vector<Collider> bodies_, pins_;
  std::vector<Linkage> linkages_;  ///< of the bodies
  std::vector<JoinedBody> joined_;
  std::vector<std::string> remarks_;
  ContactSurfaces contacts_;
  std::vector<RestPair> rest_pairs_;
  EdgeId edge_begin_ = 0;  ///< of the next cloth
};

// The cloth whose springs ask for the shortest steps.
const ClothSpec& stiffest_cloth(const Scene& scene) {
  return *std::ranges::min_element(scene.cloths, {}, [&](const ClothSpec& cloth) {
    WorldBuilder alone(scene);
    alone.add_cloth(cloth);
    return alone.take(alone.vertex_count()).stable_step_s;
  });
}

void require_stable_step(const Scene& scene, double stable_step_s) {
  const std::optional<double> given_s = scene.time.dynamics_step_s;
  if (given_s && !(*given_s < stable_step_s)) {
    io::bad_input_at_line(
        scene.file.string(), scene.time.dynamics_step_line,
        fmt::format(
            "time: dynamics_step_s = {} is not stable for these springs; lower it below {:.3g} or leave it out, "
            "or set solver = \"implicit\"",
            *given_s, stable_step_s));
  }
  if (!(stable_step_s >= kLeastStepShare / scene.time.frames_per_s)) {
    const ClothSpec& stiffest = stiffest_cloth(scene);
    io::bad_input_at_line(
        scene.file.string(), stiffest.stiffest_line,
        fmt::format(
            "\"{}\": its springs are stable below steps of {:.3g} s only, more than a million in a frame; lower "
            "{}, raise density_kg_m2 or frames_per_s, or set solver = \"implicit\"",
            stiffest.name, stable_step_s, stiffest.stiffest_key));
  }
}

}  // namespace

World build_world(const Scene& scene) {
  const FpEnvGuard guard;
  WorldBuilder builder(scene);
  for (const ClothSpec& cloth : scene.cloths) builder.add_cloth(cloth);
  const std::int32_t cloth_vertex_count = builder.vertex_count();
  for (const BodySpec& body : scene.bodies) builder.add_body(body);
  for (std::size_t cloth = 0; cloth < scene.cloths.size(); ++cloth) builder.add_pins(cloth);
  World world = builder.take(cloth_vertex_count);
  if (scene.solver == Solver::kExplicit) require_stable_step(scene, world.stable_step_s);
  return world;
}

ScriptedVertices scripted_at(const World& world, double time_s) {
  ScriptedVertices scripted{world.inverse_mass, std::vector<std::int32_t>(world.inverse_mass.size(), -1)};
  for (std::size_t id = 0; id < world.colliders.size(); ++id) {
    if (!world.colliders[id].holds(time_s)) continue;
    for (const VertexId vertex : world.colliders[id].vertices()) {
      scripted.inverse_mass[static_cast<std::size_t>(vertex)] = 0;
      scripted.body[static_cast<std::size_t>(vertex)] = static_cast<std::int32_t>(id);
    }
  }
  return scripted;
}

CollisionBodies bodies_of(const World& world, const ScriptedVertices& scripted, SqueezePolicy squeeze) {
  return {scripted.inverse_mass, scripted.body, squeeze, world.body_count, world.deforms};
}

}  // namespace selvage::sim
