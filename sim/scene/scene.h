// What a scene file asks for, as plain data in SI units. The schema with every default is docs/scenes.md.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sim/contact/collision_bodies.h"
#include "sim/contact/collision_options.h"
#include "sim/scene/garment.h"
#include "sim/scene/rigid_path.h"
#include "sim/springs/strain.h"

namespace selvage::sim {

/// How the springs are integrated: central differencing (central_differences.h), or implicitly (implicit_dynamics.h).
enum class Solver : std::uint8_t { kExplicit, kImplicit };

/// Which of the two values holds where a scene file has {draft = ..., full = ...}.
enum class Quality : std::uint8_t { kDraft, kFull };

struct SheetSpec {
  std::int32_t nx = 0, ny = 0;  ///< vertices
  double width_m = 0, height_m = 0;
};
struct SphereSpec {
  double radius_m = 0;
  std::int32_t subdivisions = 3;
};
struct BoxSpec {
  Vec3 size_m = Vec3::Zero();
  std::int32_t cells = 1;
};
struct EllipsoidSpec {
  Vec3 size_m = Vec3::Zero();
  std::int32_t subdivisions = 3;
};
struct CapsuleSpec {
  Vec3 end_m = Vec3::Zero();
  double radius_m = 0, end_radius_m = 0;
  std::int32_t segments = 16;
};
struct MeshSpec {
  std::filesystem::path file;
  double scale = 1;      ///< m per unit of the file
  std::size_t line = 0;  ///< in the scene file; what the mesh file holds shows only in the world
};
using Surface = std::variant<SheetSpec, SphereSpec, EllipsoidSpec, CapsuleSpec, BoxSpec, GarmentSpec, MeshSpec>;

/// A mesh that deforms over time.
struct SequenceSpec {
  std::filesystem::path file;          ///< a folder, an .npz, a point cache, or meshes with * for the frame's number
  std::filesystem::path base;          ///< the mesh that a point cache moves; empty: the one beside it
  double scale = 1;                    ///< m per unit of the file
  std::optional<double> frames_per_s;  ///< none: the times of the file, in seconds
  double start_s = 0;                  ///< the scene's time of its first frame
  std::size_t line = 0;                ///< in the scene file; what the sequence holds shows only in the world
};
using BodySurface = std::variant<Surface, SequenceSpec>;

struct ScriptSpec {
  Pose placement;             ///< the keys are relative to it
  std::vector<PoseKey> keys;  ///< at least one
  Interpolation interpolation = Interpolation::kLinear;
};

/// Vertices of a cloth that a script or a body holds instead of the dynamics.
struct PinSpec {
  std::vector<VertexId> vertices;   ///< of the cloth, sorted, unique
  std::size_t vertices_line = 0;    ///< in the file; whether a mesh has them shows only in the world
  ScriptSpec script;                ///< relative to where the vertices start, turning about their mean
  std::optional<std::size_t> body;  ///< that carries them, in place of the script
  double release_s = std::numeric_limits<double>::infinity();
};

struct ClothSpec {
  std::string name;
  Surface surface;  ///< a sheet, a garment or a mesh file
  Pose placement;
  Vec3 velocity_m_s = Vec3::Zero();  ///< at the start
  double density_kg_m2 = 0;
  std::size_t masses_line = 0;  ///< in the file; whether every vertex has a mass shows only in the world
  enum class Masses { kEqual, kArea } masses = Masses::kEqual;
  double stretch_n_m = 0, shear_n_m = 0, bend_n_m = 0;  ///< 0: no such springs
  double stabilize_n_m = 0;                             ///< 0: no stabilisation springs
  std::string stiffest_key;       ///< of the largest of these; whether a step is short enough shows only in the world
  std::size_t stiffest_line = 0;  ///< in the file
  double damping_ratio = 0;       ///< of each spring's critical damping
  std::vector<PinSpec> pins;
  std::optional<ContactProperties> contact;  ///< none: the scene's
  std::size_t thickness_line = 0;  ///< in the file; whether the cloth is too thick for its mesh shows only in the world
};

struct BodySpec {
  std::string name;
  BodySurface surface;
  ScriptSpec script;
  std::optional<std::size_t> parent;         ///< an earlier body, in whose frame the script is; none: the world
  std::optional<ContactProperties> contact;  ///< none: the scene's
};

struct TimeSpec {
  double frames_per_s = 30;
  std::int64_t frame_count = 0;  ///< after the initial one
  std::optional<double>
      dynamics_step_s;  ///< none: from the springs' stability limit, or the collision step where implicit
  std::size_t dynamics_step_line = 0;  ///< in the file; whether the step is stable shows only in the world
  std::optional<double> min_step_s;    ///< none: the dynamics' step, or an eighth of max_step_s where implicit
  std::optional<double> max_step_s;    ///< none: one frame, at most kLongestImplicit_s where implicit
};

struct Scene {
  std::filesystem::path file;
  Quality quality = Quality::kDraft;
  TimeSpec time;
  Solver solver = Solver::kExplicit;
  Vec3 gravity_m_s2 = Vec3::Zero();
  double drag_1_s = 0, quadratic_drag_1_m = 0;
  StrainLimits strain;
  CollisionOptions collision;
  std::int32_t contact_sweeps = 1;  ///< over the contacts that explicit dynamics hold, in each of their steps
  SqueezePolicy squeeze = SqueezePolicy::kStop;
  std::vector<ClothSpec> cloths;
  std::vector<BodySpec> bodies;
};

}  // namespace selvage::sim
