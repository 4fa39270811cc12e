#include "sim/world.h"

#include <array>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim/description.h"
#include "tests/sim/small_scene.h"

namespace selvage {

using namespace sim;
using testing::small_scene_text;
using testing::TemporaryFolder;

TEST(World, PartsAreInOrderAndPinsAreColliders) {
  const Scene scene = parse_scene(small_scene_text(1), "small.toml");
  const World world = build_world(scene);
  ASSERT_EQ(world.groups.size(), 3u);
  EXPECT_EQ(world.groups[0].name, "sheet");
  EXPECT_EQ(world.groups[2].role, io::Group::Role::kBody);
  EXPECT_EQ(world.groups[2].face_end, static_cast<FaceId>(world.triangles.size()));
  EXPECT_EQ(world.cloth_vertex_count, 196);
  EXPECT_NEAR(1 / world.inverse_mass[0], 0.3 * 0.49 / 196, 1e-15);
  EXPECT_EQ(world.inverse_mass.back(), 0);
  EXPECT_EQ(world.body_count, 2);
}

TEST(World, SpringsAndStabilisersOfEveryClothAreBetweenItsOwnVertices) {
  const std::string head = "[time]\nframes = 1\n";
  const auto sheet = [](int side, double z) {
    return "[[cloth]]\nname = \"of " + std::to_string(side) + "\"\nsheet = {nx = " + std::to_string(side) +
           ", ny = 3, width_m = 0.3, height_m = 0.2}\nposition_m = [0, 0, " + std::to_string(z) +
           "]\ndensity_kg_m2 = 0.3\nstretch_n_m = 40\nbend_n_m = 0.5\nstabilize_n_m = 0.2\n";
  };
  const auto build = [&](const std::string& cloths) { return build_world(parse_scene(head + cloths, "cloths.toml")); };
  const World both = build(sheet(4, 0) + sheet(5, 1));
  std::size_t spring = 0, stabilizer = 0;
  VertexId begin = 0;
  for (const World& alone : {build(sheet(4, 0)), build(sheet(5, 1))}) {
    for (const Spring& own : alone.springs.springs()) {
      const Spring& found = both.springs.springs().at(spring++);
      EXPECT_EQ((std::array{found.a, found.b}), (std::array{begin + own.a, begin + own.b}));
    }
    for (const Stabilizer& own : alone.stabilizers.stabilizers()) {
      const Stabilizer& found = both.stabilizers.stabilizers().at(stabilizer++);
      EXPECT_EQ(found.weights, own.weights);
      for (std::size_t k = 0; k < 4; ++k) {
        if (own.weights[k] == 0) continue;
        EXPECT_EQ(found.vertices[k], begin + own.vertices[k]);
      }
    }
    begin += alone.cloth_vertex_count;
  }
  EXPECT_EQ(both.springs.springs().size(), spring);
  EXPECT_EQ(both.stabilizers.stabilizers().size(), stabilizer);
  EXPECT_GT(stabilizer, 10U);
}

TEST(World, DescriptionNamesOnlyWhatIsModelled) {
  Scene full = parse_scene(small_scene_text(1), "small.toml");
  full.contact_sweeps = 4;
  full.cloths[0].damping_ratio = 0.25;
  full.squeeze = SqueezePolicy::kYield;
  const std::string all = describe(full, build_world(full));
  for (const char* part : {"gravity", "friction", "bending", "shear", "strain", "ball", "4 sweeps",
                           "sheet: 0.25 of critical", "bodies wait"}) {
    EXPECT_NE(all.find(part), std::string::npos) << part;
  }
  const Scene bare = parse_scene(R"(
strain_limit = 0
strain_rate_limit = 0
[time]
frames = 1
[[cloth]]
sheet = {nx = 4, ny = 4, width_m = 0.3, height_m = 0.3}
density_kg_m2 = 0.3
stretch_n_m = 40
)",
                                 "bare.toml");
  const std::string least = describe(bare, build_world(bare));
  for (const char* part :
       {"gravity", "friction", "bending", "shear", "strain", "body", "pin", "drag", "sweeps", "critical", "wait"}) {
    EXPECT_EQ(least.find(part), std::string::npos) << part;
  }
}

TEST(World, RefusesAnUnstableDynamicsStep) {
  std::string text = small_scene_text(1);
  text.replace(text.find("[time]\n"), 7, "[time]\ndynamics_step_s = 0.02\n");
  EXPECT_THROW((void)build_world(parse_scene(text, "small.toml")), io::Error);
}

// More than a million steps a frame: with 1e20 N/m their number was no int, and the cloth stayed where it was.
TEST(World, RefusesSpringsThatNoStepOfTheDynamicsIsShortEnoughFor) {
  for (const char* stiffness : {"1e14", "1e20", "1e30"}) {
    std::string text = small_scene_text(1);
    text.replace(text.find("stretch_n_m = 40"), 16, std::string("stretch_n_m = ") + stiffness);
    EXPECT_THROW((void)build_world(parse_scene(text, "small.toml")), io::Error) << stiffness;
    EXPECT_NO_THROW((void)build_world(parse_scene("solver = \"implicit\"\n" + text, "small.toml"))) << stiffness;
  }
}

TEST(World, RefusesAMassWhoseInverseIsNoNumber) {
  const auto with_density = [](const std::string& density_kg_m2) {
    std::string text = "solver = \"implicit\"\n" + small_scene_text(1);
    text.replace(text.find("density_kg_m2 = 0.3"), 19, "density_kg_m2 = " + density_kg_m2);
    return parse_scene(text, "small.toml");
  };
  EXPECT_NO_THROW((void)build_world(with_density("1e-290")));
  try {
    (void)build_world(with_density("1e-309"));
    FAIL();
  } catch (const io::Error& error) {
    const std::string what = error.what();
    EXPECT_TRUE(what.starts_with("small.toml:12: \"sheet\" has a vertex of ")) << what;
    EXPECT_TRUE(what.ends_with("raise density_kg_m2")) << what;
  }
}

TEST(World, ReadsMeshFilesBesideTheScene) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "two.obj") << "v 0 0 0\nv 100 0 0\nv 0 100 0\nv 100 100 0\nf 1 2 3\nf 2 4 3\n";
  const Scene scene = testing::write_and_read_scene(folder.path() / "mesh.toml", R"(
[time]
frames = 1
[[cloth]]
mesh = {file = "two.obj", scale = 0.01}
density_kg_m2 = 0.5
stretch_n_m = 40
bend_n_m = 1
masses = "area"
[[cloth.pin]]
vertices = [3]
)");
  const World world = build_world(scene);
  EXPECT_EQ(world.x_t0(3, 0), 1);
  EXPECT_EQ(world.springs.springs().size(), 6u);
  EXPECT_NEAR(1 / world.inverse_mass[1], 0.5 / 3, 1e-15);
  EXPECT_EQ(world.colliders.at(0).vertices(), std::vector<VertexId>{3});
  Scene beyond = scene;
  beyond.cloths[0].pins[0].vertices = {4};
  EXPECT_THROW((void)build_world(beyond), io::Error);
}

TEST(World, VerticesOfNoFaceAreNamedWhereTheyAreCloth) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "loose.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nv 6 6 6\nf 1 2 3\n";
  const std::string cloth = "[time]\nframes = 1\n[[cloth]]\ndensity_kg_m2 = 0.5\nstretch_n_m = 40\n";
  const std::string loose = "mesh = {file = \"loose.obj\"}\n";
  const auto description = [&](const std::string& text) {
    const Scene scene = testing::write_and_read_scene(folder.path() / "loose.toml", text);
    return describe(scene, build_world(scene));
  };
  EXPECT_NE(description(cloth + loose).find("2 cloth vertices of no face"), std::string::npos);
  const std::string sheet = "sheet = {nx = 3, ny = 3, width_m = 1, height_m = 1}\n";
  EXPECT_EQ(description(cloth + sheet + "[[body]]\n" + loose).find("of no face"), std::string::npos);
}

}  // namespace selvage
