#include "sim/scene/scene_reader.h"

#include <string>

#include <gtest/gtest.h>

#include "sim/description.h"
#include "sim/world.h"

namespace selvage {

using namespace sim;

namespace {

// Line 1 is [time]; the cloth's table starts at line 4; what a test appends starts at line 9.
const std::string kScene =
    "[time]\n"
    "frames = 10\n"
    "\n"
    "[[cloth]]\n"
    "density_kg_m2 = 0.2\n"
    "stretch_n_m = 50\n"
    "sheet = {nx = 5, ny = 4, width_m = 1, height_m = 0.8}\n"
    "\n";

struct BadScene {
  const char* why;
  std::string text;
  int line;
  const char* message;  ///< part of the error
};

const BadScene kBadScenes[] = {
    {"syntax", kScene + "[[body]\n", 9, "TOML syntax"},
    {"no time", "gravity_m_s2 = [0, 0, -9.81]\n", 1, "[time] is missing"},
    {"no cloth", "[time]\nframes = 1\n", 1, "no cloth"},
    {"unknown root key", "gravty = 1\n" + kScene, 1,
     "unknown key \"gravty\"; it may be meant for gravity_m_s2; known here: time, gravity_m_s2, "},
    {"a misspelt key that is required",
     "[time]\nframes = 1\n[[cloth]]\nsheet = {nx = 3, ny = 3, width_m = 1, height_m = 1}\n"
     "density_kg_m2 = 1\nstreach_n_m = 1\n",
     6, "unknown key \"streach_n_m\"; it may be meant for stretch_n_m; known here: "},
    {"a misspelt key that one of two choices requires", "[time]\nframes_per_s = 30\nduration = 2\n", 3,
     "unknown key \"duration\"; it may be meant for duration_s; known here: "},
    {"a unit in full",
     kScene + "[[body]]\n[body.sequence]\nfile = \"walk_*.obj\"\nstart_s = 1\nframes_per_second = 24\n", 13,
     "unknown key \"frames_per_second\"; it may be meant for frames_per_s; known here: file, base, "},
    {"a misspelt key beside the right one", kScene + "[collision]\nthicknes_m = 1e-3\nthickness_m = 1e-3\n", 10,
     "unknown key \"thicknes_m\"; it may be meant for thickness_m, which is there too; known here: "},
    {"a misspelt key before a bad value", "[time]\nframes = -1\nmax_steps = 1\n", 3, "meant for max_step_s; "},
    {"a misspelt key of the last body before a fault of the cloth",
     "[time]\nframes = 1\n[[cloth]]\n[[body]]\nsphere = {radius_m = 1}\nparnt = \"a\"\n", 6, "meant for parent; "},
    {"a missing key whose neighbour is there", "[time]\nframes = 1\n[[cloth]]\nsheet = {ny = 3}\n", 4, "nx is missing"},
    {"a key like no other", "[time]\nframes = 1\nfps = 30\n", 3, "unknown key \"fps\"; known here: "},
    {"unknown key in a part", kScene + "[[body]]\nspher = {radius_m = 1}\nsphere = {radius_m = 1}\n", 10, "\"spher\""},
    {"unknown key in a surface", kScene + "[[body]]\nsphere = {radius_m = 1, cells = 2}\n", 10, "\"cells\""},
    {"unknown key beside frames", "[time]\nframes = 6\nfps = 24\n", 3,
     "known here: frames_per_s, frames, duration_s, dynamics_step_s, max_step_s, min_step_s"},
    {"unknown key beside duration_s", "[time]\nduration_s = 6\nfps = 24\n", 3, "known here: frames_per_s, frames, dur"},
    {"unknown key in a body", kScene + "[[body]]\nsphere = {radius_m = 1}\nparnt = \"a\"\n", 11, ", parent, "},
    {"unknown key beside an edge", kScene + "[[cloth.pin]]\nedge = \"top\"\nvertice = [1]\n", 11,
     "meant for vertices; known here: edge, vertices, "},
    {"unknown key in a cloth", kScene + "copy_offset = [0, 0, 1]\n", 9, ", copies, copy_offset_m, "},
    {"unknown key in a collision", kScene + "[collision]\nrepulsion_stiffness = 3\n", 10,
     "known here: repulsion_stiffness_n_m, contact_sweeps, thickness_m, tolerance_m, repulsion, overlap_fraction, "},
    {"no length", "[time]\nframes_per_s = 30\n", 1, "add frames or duration_s"},
    {"both ends of a choice", "[time]\nframes = 3\nduration_s = 1\n", 1, "frames or duration_s"},
    {"a negative density",
     "[time]\nframes = 1\n[[cloth]]\ndensity_kg_m2 = -1\nstretch_n_m = 1\n"
     "sheet = {nx = 5, ny = 4, width_m = 1, height_m = 0.8}\n",
     4, "density_kg_m2 must be a number above 0"},
    {"a string for a number", "[time]\nframes = \"ten\"\n", 2, "frames must be an integer"},
    {"a fraction for a count", "[time]\nframes = 2.5\n", 2, "frames must be an integer"},
    {"infinity", kScene + "drag = 1\n[collision]\nthickness_m = inf\n", 11, "thickness_m must be a number above 0"},
    {"a size beyond all places", kScene + "[[body]]\nsphere = {radius_m = 1e300}\n", 10,
     "radius_m must be a number of at least 1e-30 and at most 1000000000"},
    {"a stiffness beyond all", kScene + "shear_n_m = 1e300\n", 9,
     "shear_n_m must be a number of at least 0 and at most"},
    {"nan", "drag_1_s = nan\n" + kScene, 1, "drag_1_s"},
    {"two numbers for a vector", "gravity_m_s2 = [0, 0]\n" + kScene, 1, "three numbers"},
    {"tolerance above thickness", kScene + "[collision]\nthickness_m = 1e-3\ntolerance_m = 2e-3\n", 11,
     "below thickness_m"},
    {"kinetic above static", kScene + "[collision]\nfriction_static = 0.2\nfriction_kinetic = 0.3\n", 11,
     "must not exceed friction_static"},
    {"kinetic friction alone", kScene + "[collision]\nfriction_kinetic = 0.3\n", 10,
     "must not exceed friction_static, which is 0"},
    {"a negative thickness of a part", kScene + "[[body]]\nsphere = {radius_m = 1}\nthickness_m = -1\n", 11,
     "thickness_m must be a number above 0"},
    {"a part's tolerance above its thickness", kScene + "[[body]]\nsphere = {radius_m = 1}\ntolerance_m = 2e-3\n", 11,
     "below thickness_m"},
    {"a part's thickness below the tolerance", kScene + "[[body]]\nsphere = {radius_m = 1}\nthickness_m = 1e-7\n", 11,
     "below thickness_m"},
    {"a part's kinetic friction above its static one",
     kScene + "[[body]]\nsphere = {radius_m = 1}\nfriction_static = 0.2\nfriction_kinetic = 0.3\n", 12,
     "must not exceed friction_static"},
    {"a tolerance that another part's thickness cannot keep",
     kScene + "[[body]]\nsphere = {radius_m = 1}\nthickness_m = 1e-2\ntolerance_m = 9e-3\n", 12,
     "with a part above it has the tolerance 0.009 m at the thickness 0.0055 m"},
    {"an unknown policy", "squeeze = \"explode\"\n" + kScene, 1, "\"stop\", \"yield\""},
    {"an unknown solver", "solver = \"magic\"\n" + kScene, 1, "\"explicit\", \"implicit\""},
    {"a limit of the other solver", "solver = \"implicit\"\nstrain_rate_limit = 0.1\n" + kScene, 2, "leave it out"},
    {"sweeps under the other solver", "solver = \"implicit\"\n" + kScene + "[collision]\ncontact_sweeps = 4\n", 11,
     "leave it out"},
    {"no sweep", kScene + "[collision]\ncontact_sweeps = 0\n", 10, "contact_sweeps must be an integer"},
    {"too many sweeps", kScene + "[collision]\ncontact_sweeps = 101\n", 10, "contact_sweeps must be an integer"},
    {"two surfaces", kScene + "[[body]]\nsphere = {radius_m = 1}\nbox = {size_m = [1, 1, 1]}\n", 11, "second surface"},
    {"no surface", kScene + "[[body]]\nname = \"air\"\n", 9, "no surface"},
    {"an empty name", kScene + "[[body]]\nname = \"\"\nsphere = {radius_m = 1}\n", 10, "an empty name"},
    {"a name twice", kScene + "[[body]]\nname = \"cloth\"\nsphere = {radius_m = 1}\n", 10, "a second \"cloth\""},
    {"a copy called like another part",
     kScene + "copies = 2\ncopy_offset_m = [0, 0, 1]\n[[body]]\nname = \"cloth 2\"\nsphere = {radius_m = 1}\n", 12,
     "a second \"cloth 2\""},
    {"copies that go too far", kScene + "copies = 3\ncopy_offset_m = [0, 0, -6e8]\n", 10,
     "copy 3 is at a coordinate beyond 1000000000 m; lower copies or copy_offset_m"},
    {"copies without an offset", kScene + "copies = 2\n", 4, "copy_offset_m is missing"},
    {"copies in the same place", kScene + "copies = 2\ncopy_offset_m = [0, 0, 0]\n", 10,
     "copy_offset_m = [0, 0, 0] puts all 2 copies at one place; move each along by its thickness or more"},
    {"an offset for one copy", kScene + "copies = 1\ncopy_offset_m = [0, 0, 1]\n", 10,
     "copies = 1 is this cloth alone; raise it, or remove copy_offset_m"},
    {"an offset without copies", kScene + "copy_offset_m = [0, 0, 1]\n", 9, "give copies too"},
    {"keys out of order",
     kScene + "[[body]]\nsphere = {radius_m = 1}\n[[body.key]]\ntime_s = 1\n[[body.key]]\ntime_s = 1\n", 14,
     "must grow"},
    {"a parent below", kScene + "[[body]]\nparent = \"hip\"\nsphere = {radius_m = 1}\n[[body]]\nname = \"hip\"\n", 10,
     "no body \"hip\" above"},
    {"repeat without keys", kScene + "[[body]]\nsphere = {radius_m = 1}\nrepeat = 2\n", 11, "two keys"},
    {"a cycle that does not close",
     kScene + "[[body]]\nsphere = {radius_m = 1}\nrepeat = 2\nkey = [{time_s = 0}, {time_s = 1, "
              "rotation_deg = [0, 0, 9]}]\n",
     11, "the pose of the first"},
    {"too many keys",
     kScene + "[[body]]\nsphere = {radius_m = 1}\nrepeat = 100000\nkey = [{time_s = 0}, {time_s = 1}, {time_s = 2},\n"
              "{time_s = 3}, {time_s = 4}, {time_s = 5}, {time_s = 6}, {time_s = 7}, {time_s = 8}, {time_s = 9}, "
              "{time_s = 10}]\n",
     11, "lower repeat"},
    {"an unknown interpolation", kScene + "[[body]]\nsphere = {radius_m = 1}\ninterpolation = \"cubic\"\n", 11,
     "\"spline\""},
    {"a capsule in a capsule", kScene + "[[body]]\ncapsule = {end_m = [0, 0, 1], radius_m = 2, end_radius_m = 1}\n", 10,
     "holds the other"},
    {"a garment of one ring",
     "[time]\nframes = 1\n[[cloth]]\n[cloth.garment]\ncell_m = 0.1\n[[cloth.garment.ring]]\nheight_m = 1\n"
     "depth_m = 1\nwidth_m = 1\n",
     4, "two rings"},
    {"cells beyond counting",
     "[time]\nframes = 1\n[[cloth]]\n[cloth.garment]\ncell_m = 0.1\n"
     "ring = [{height_m = 2, depth_m = 1, width_m = 1}, {height_m = 1, depth_m = 1, width_m = 1}]\n"
     "sleeves = {top_m = 1.8, bottom_m = 1.4, depth_m = 0.3, length_m = 1e9, cuff_radius_m = 0.1}\n",
     5, "cell_m must be"},
    {"rings that rise",
     "[time]\nframes = 1\n[[cloth]]\n[cloth.garment]\ncell_m = 0.1\n"
     "ring = [{height_m = 1, depth_m = 1, width_m = 1},\n{height_m = 1, depth_m = 1, width_m = 1}]\n",
     7, "from the top down"},
    {"a pin that holds nothing", kScene + "[[cloth.pin]]\nrelease_s = 1\n", 9,
     "nothing says what it holds; add edge = \"top\", \"bottom\", \"left\" or \"right\", or vertices = [...]"},
    {"a pin that holds nothing of a mesh",
     "[time]\nframes = 1\n[[cloth]]\ndensity_kg_m2 = 1\nstretch_n_m = 1\nmesh = {file = \"a.obj\"}\n[[cloth.pin]]\n", 7,
     "vertices is missing; add vertices = [...]"},
    {"a pinned vertex out of range", kScene + "[[cloth.pin]]\nvertices = [0, 20]\n", 10, "from 0 to 19"},
    {"a pin on a body that is not there", kScene + "[[cloth.pin]]\nedge = \"top\"\nbody = \"hip\"\n", 11,
     "no body \"hip\"; name one of the scene"},
    {"a pin on a body with a script",
     kScene +
         "[[cloth.pin]]\nedge = \"top\"\nbody = \"body\"\nkey = [{time_s = 0}]\n[[body]]\nsphere = {radius_m = 1}\n",
     12, "a pin with a body moves as that does; leave out key"},
    {"a vertex pinned twice", kScene + "[[cloth.pin]]\nedge = \"top\"\n[[cloth.pin]]\nedge = \"left\"\n", 11,
     "pinned already"},
    {"a pin that starts elsewhere", kScene + "[[cloth.pin]]\nedge = \"top\"\nposition_m = [0, 0, 1]\n", 9,
     "starts where"},
    {"a shortest step above the longest", "[time]\nframes = 1\nmax_step_s = 1e-3\nmin_step_s = 2e-3\n", 4,
     "min_step_s = 0.002 is longer than max_step_s, 0.001 s; lower it"},
    {"a shortest step above the implicit solver's longest",
     "solver = \"implicit\"\n[time]\nframes = 1\nmin_step_s = 0.006\n", 4,
     "min_step_s = 0.006 is longer than the default max_step_s of solver = \"implicit\""},
    {"a longest step of two frames", "[time]\nframes = 1\nframes_per_s = 50\nmax_step_s = 0.04\n", 4,
     "max_step_s = 0.04 is longer than a frame, 0.02 s; lower it"},
    {"a frame without end", "[time]\nframes_per_s = 1e-7\nframes = 1\n", 2, "at least 1e-06"},
    {"one quality of two", "[time]\nframes = {draft = 2}\n", 2, "{draft = ..., full = ...} with both"},
    {"a bad value for one quality", "[time]\nframes = {draft = 0, full = 2}\n", 2, "an integer"},
    {"a bad value for the other", "[time]\nframes = {draft = 2, full = \"x\"}\n", 2, "an integer"},
    {"a mesh without a name", kScene + "[[body]]\nmesh = {file = \"\"}\n", 10, "file is empty; name one"},
    {"a sequence without a name", kScene + "[[body]]\nsequence = {file = \"\"}\n", 10, "file is empty; name one"},
    {"shear on a mesh",
     "[time]\nframes = 1\n[[cloth]]\ndensity_kg_m2 = 1\nstretch_n_m = 1\nmesh = {file = \"a.obj\"}\n"
     "shear_n_m = 2\n",
     7, "only sheets"},
};

}  // namespace

TEST(SceneReader, EveryErrorNamesItsLineAndARemedy) {
  for (const BadScene& bad : kBadScenes) {
    try {
      (void)parse_scene(bad.text, "bad.toml");
      ADD_FAILURE() << bad.why << ": no error";
    } catch (const io::Error& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.kind(), io::ErrorKind::kBadInput) << bad.why;
      EXPECT_TRUE(what.starts_with("bad.toml:" + std::to_string(bad.line) + ": ")) << bad.why << ": " << what;
      EXPECT_NE(what.find(bad.message), std::string::npos) << bad.why << ": " << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << bad.why << ": " << what;
    }
  }
}

// toml++ ends the program on these, by an assertion; found by `selvage fuzz files`.
TEST(SceneReader, MalformedTomlIsAnErrorNotAnAbort) {
  for (const char* text : {"[ = {nx = 2}\n", "[time]\nframes = 2\n[ = 1\n", "a = \n]\n"}) {
    EXPECT_THROW((void)parse_scene(text, "bad.toml"), io::Error) << text;
  }
}

TEST(SceneReader, APartHasItsOwnContactPropertiesAndTheScenesForTheRest) {
  const Scene scene =
      parse_scene(kScene +
                      "[[body]]\nname = \"a\"\nsphere = {radius_m = 1}\nfriction_static = 0.2\n"
                      "[[body]]\nname = \"b\"\nsphere = {radius_m = 1}\nthickness_m = 2e-2\ntolerance_m = 9e-3\n"
                      "[[body]]\nname = \"c\"\nsphere = {radius_m = 1}\n"
                      "[collision]\nthickness_m = 5e-3\nfriction_static = 0.5\nfriction_kinetic = 0.3\n",
                  "scene.toml");
  EXPECT_EQ(scene.bodies[0].contact, (ContactProperties{5e-3, 1e-6, 0.2, 0.2})) << "kinetic: its own static";
  EXPECT_EQ(scene.bodies[1].contact, (ContactProperties{2e-2, 9e-3, 0.5, 0.3}));
  EXPECT_FALSE(scene.bodies[2].contact);
  EXPECT_FALSE(scene.cloths[0].contact);
  const World world = build_world(scene);
  EXPECT_EQ(world.contacts.properties.size(), 3U);
  EXPECT_EQ(world.contacts.surface_of_vertex.back(), 0) << "the scene's";
  const std::string text = describe(scene, world);
  EXPECT_NE(text.find("a: tolerance 1e-06 m, repulsion below 0.005 m, friction 0.2 static, 0.2 kinetic"),
            std::string::npos)
      << text;
  EXPECT_TRUE(build_world(parse_scene(kScene, "scene.toml")).contacts.properties.empty());
}

TEST(SceneReader, DefaultsAreThePapers) {
  const Scene scene = parse_scene(kScene, "scene.toml");
  EXPECT_EQ(scene.collision.thickness_m, 1e-3);
  EXPECT_EQ(scene.collision.tolerance_m, 1e-6);
  EXPECT_EQ(scene.collision.overlap_fraction, 0.1);
  EXPECT_EQ(scene.contact_sweeps, 1);
  EXPECT_EQ(scene.collision.repulsion_stiffness_n_m, 50) << "that of the stretch springs (7.2)";
  EXPECT_EQ(scene.strain.strain, 0.1);
  EXPECT_EQ(scene.strain.strain_rate, 0.1);
  EXPECT_EQ(scene.gravity_m_s2, Vec3(Vec3::Zero())) << "what is not asked for is not modelled";
  EXPECT_EQ(scene.collision.friction_static, 0);
  EXPECT_EQ(scene.cloths.at(0).bend_n_m, 0);
  EXPECT_EQ(scene.squeeze, SqueezePolicy::kStop);
  EXPECT_EQ(scene.time.frames_per_s, 30);
  EXPECT_EQ(scene.time.frame_count, 10);
}

TEST(SceneReader, ADurationIsComparedAsTheFramesThatItIsRoundedTo) {
  const std::string cloth = kScene.substr(kScene.find("[[cloth]]"));
  EXPECT_EQ(parse_scene("[time]\nduration_s = 33333.3\n" + cloth, "long.toml").time.frame_count, 999'999);
  EXPECT_EQ(parse_scene("[time]\nduration_s = 1e-9\n" + cloth, "short.toml").time.frame_count, 1);
  EXPECT_THROW((void)parse_scene("[time]\nduration_s = 33333.32\n" + cloth, "longer.toml"), io::Error);
}

TEST(SceneReader, ReadsWhatItIsGiven) {
  const Scene scene = parse_scene(R"(
gravity_m_s2 = [0, 0, -9.81]
drag_1_s = 0.5
squeeze = "yield"
[time]
frames_per_s = 24
duration_s = 2
min_step_s = 0.005
[collision]
friction_static = 0.6
contact_sweeps = 3
precision = "float32"
[[cloth]]
name = "curtain"
sheet = {nx = 3, ny = 2, width_m = 1, height_m = 2}
position_m = [0, 0, 1]
rotation_deg = [90, 0, 0]
density_kg_m2 = 0.15
stretch_n_m = 40
shear_n_m = 20
bend_n_m = 0.1
masses = "area"
[[cloth.pin]]
edge = "top"
release_s = 0.5
[[cloth.pin]]
vertices = [1, 0]
interpolation = "smooth"
[[cloth.pin.key]]
time_s = 0
[[cloth.pin.key]]
time_s = 1
position_m = [1, 0, 0]
[[body]]
box = {size_m = [1, 2, 3], cells = 4}
[[body.key]]
time_s = 0.25
rotation_deg = [0, 0, 90]
)",
                                  "scene.toml");
  EXPECT_EQ(scene.time.frame_count, 48);
  EXPECT_EQ(scene.time.min_step_s, 0.005);
  EXPECT_EQ(scene.gravity_m_s2, Vec3(0, 0, -9.81));
  EXPECT_EQ(scene.drag_1_s, 0.5);
  EXPECT_EQ(scene.squeeze, SqueezePolicy::kYield);
  EXPECT_EQ(scene.collision.friction_static, 0.6);
  EXPECT_EQ(scene.collision.friction_kinetic, 0.6) << "one coefficient, as in the paper";
  EXPECT_EQ(scene.contact_sweeps, 3);
  EXPECT_EQ(scene.collision.precision, CollisionOptions::Precision::kFloat32);
  const ClothSpec& cloth = scene.cloths.at(0);
  EXPECT_EQ(cloth.placement.rotation_deg, Vec3(90, 0, 0));
  EXPECT_EQ(cloth.masses, ClothSpec::Masses::kArea);
  EXPECT_EQ(cloth.pins.at(0).vertices, (std::vector<VertexId>{3, 4, 5}));
  EXPECT_EQ(cloth.pins.at(0).release_s, 0.5);
  EXPECT_EQ(cloth.pins.at(1).vertices, (std::vector<VertexId>{0, 1}));
  EXPECT_EQ(cloth.pins.at(1).script.keys.at(1).pose.position_m, Vec3(1, 0, 0));
  EXPECT_EQ(cloth.pins.at(1).script.interpolation, Interpolation::kSmooth);
  EXPECT_EQ(std::get<BoxSpec>(std::get<Surface>(scene.bodies.at(0).surface)).cells, 4);
  EXPECT_EQ(scene.bodies.at(0).script.keys.at(0).pose.rotation_deg, Vec3(0, 0, 90));
}

TEST(SceneReader, CopiesFollowEachOther) {
  const Scene scene = parse_scene(
      kScene + "name = \"layer\"\nposition_m = [0, 0, 1]\ncopies = 3\ncopy_offset_m = [0, 0.5, 0.25]\n", "");
  ASSERT_EQ(scene.cloths.size(), 3u);
  EXPECT_EQ(scene.cloths[0].name, "layer");
  EXPECT_EQ(scene.cloths[2].name, "layer 3");
  EXPECT_EQ(scene.cloths[2].placement.position_m, Vec3(0, 1, 1.5));
}

TEST(SceneReader, ReadsAFigureAndItsGarment) {
  const Scene scene = parse_scene(R"(
[time]
frames = 1
[[cloth]]
density_kg_m2 = 0.15
stretch_n_m = 40
[cloth.garment]
cell_m = 0.05
ring = [{height_m = 1.5, depth_m = 0.2, width_m = 0.3}, {height_m = 0.5, depth_m = 0.7, width_m = 0.8}]
sleeves = {top_m = 1.4, bottom_m = 1.1, depth_m = 0.2, length_m = 0.5, cuff_radius_m = 0.1, down_deg = 40}
[[body]]
name = "chest"
ellipsoid = {size_m = [0.2, 0.3, 0.5]}
[[body]]
name = "arm"
parent = "chest"
capsule = {end_m = [0, 0, -0.3], radius_m = 0.05}
position_m = [0, 0.2, 0.1]
rotation_deg = [30, 0, 0]
interpolation = "spline"
repeat = 3
key = [{time_s = 1}, {time_s = 1.5, rotation_deg = [0, 20, 0]}, {time_s = 3}]
)",
                                  "scene.toml");
  const auto& garment = std::get<GarmentSpec>(scene.cloths.at(0).surface);
  EXPECT_EQ(garment.rings.at(1).width_m, 0.8);
  EXPECT_EQ(garment.sleeves.value().down_deg, 40);
  EXPECT_FALSE(scene.bodies.at(0).parent.has_value());
  EXPECT_EQ(std::get<EllipsoidSpec>(std::get<Surface>(scene.bodies.at(0).surface)).size_m, Vec3(0.2, 0.3, 0.5));
  const BodySpec& arm = scene.bodies.at(1);
  EXPECT_EQ(arm.parent, 0u);
  EXPECT_EQ(std::get<CapsuleSpec>(std::get<Surface>(arm.surface)).end_radius_m, 0.05) << "that of the start";
  EXPECT_EQ(arm.script.placement.position_m, Vec3(0, 0.2, 0.1));
  EXPECT_EQ(arm.script.interpolation, Interpolation::kSpline);
  std::vector<double> times_s;
  for (const PoseKey& key : arm.script.keys) times_s.push_back(key.time_s);
  EXPECT_EQ(times_s, (std::vector<double>{1, 1.5, 3, 3.5, 5, 5.5, 7}));
  for (const std::size_t i : {1u, 3u, 5u}) EXPECT_EQ(arm.script.keys[i].pose.rotation_deg, Vec3(0, 20, 0));
}

TEST(SceneReader, ValuesMayDependOnTheQuality) {
  const std::string text =
      "gravity_m_s2 = {draft = [0, 0, -1], full = [0, 0, -2]}\n[time]\nframes = {draft = 2, full = 7}\n[[cloth]]\n"
      "sheet = {nx = {draft = 4, full = 9}, ny = 3, width_m = 1, height_m = 1}\n"
      "density_kg_m2 = 1\nstretch_n_m = {draft = 5, full = 6.5}\n";
  const Scene draft = parse_scene(text, "scene.toml", Quality::kDraft);
  const Scene full = parse_scene(text, "scene.toml", Quality::kFull);
  EXPECT_EQ(draft.time.frame_count, 2);
  EXPECT_EQ(full.time.frame_count, 7);
  EXPECT_EQ(std::get<SheetSpec>(draft.cloths.at(0).surface).nx, 4);
  EXPECT_EQ(std::get<SheetSpec>(full.cloths.at(0).surface).nx, 9);
  EXPECT_EQ(full.cloths.at(0).stretch_n_m, 6.5);
  EXPECT_EQ(full.gravity_m_s2, Vec3(0, 0, -2));
  EXPECT_EQ(full.quality, Quality::kFull);
}

}  // namespace selvage
