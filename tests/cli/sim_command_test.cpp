#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <regex>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/mesh_reader.h"
#include "io/sequence.h"
#include "tests/cli/run_program.h"
#include "tests/squeeze_scene.h"

namespace selvage {

using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

namespace {

std::string scene(int frames, double ball_z, double ball_end_z) {
  return "gravity_m_s2 = [0, 0, -9.81]\n[time]\nmax_step_s = 0.0167\nmin_step_s = 0.004\nframes = " +
         std::to_string(frames) + R"(
[[cloth]]
name = "sheet"
sheet = {nx = 10, ny = 10, width_m = 0.5, height_m = 0.5}
position_m = [0.03, 0.02, 0.42]
density_kg_m2 = 0.3
stretch_n_m = 40
shear_n_m = 20
[[body]]
name = "ball"
sphere = {radius_m = 0.17, subdivisions = 2}
[[body.key]]
time_s = 0
position_m = [0, 0, )" +
         std::to_string(ball_z) + "]\n[[body.key]]\ntime_s = 0.1\nposition_m = [0, 0, " + std::to_string(ball_end_z) +
         R"(]
[[body]]
name = "lid"
box = {size_m = [1, 1, 0.1]}
position_m = [0, 0, 0.52]
)";
}

class SimCommand : public ::testing::Test {
 protected:
  testing::ProgramResult sim(const std::string& text, std::vector<std::string> options = {}) {
    spit(path("scene.toml"), text);
    options.insert(options.begin(), {"sim", path("scene.toml"), "-o", path("out")});
    return run_program(folder_, options);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  TemporaryFolder folder_;
};

}  // namespace

TEST_F(SimCommand, WhatItSimulatesTheCheckerFindsClean) {
  const auto run = sim(scene(6, 0.2, 0.2), {"--record", "steps", "--threads", "2"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("gravity"), std::string::npos) << "says what it models";
  EXPECT_NE(run.out.find("6 frames"), std::string::npos) << run.out;
  EXPECT_TRUE(
      std::regex_search(run.out, std::regex("\nlargest strain 0[.0-9e-]+ at 0[.0-9]+ s, between vertices [0-9]+ and "
                                            "[0-9]+ \\(\"?sheet\"?\\)\n")))
      << run.out;
  EXPECT_TRUE(std::filesystem::exists(path("out") + "/run.json"));
  const auto check = run_program(folder_, {"verify", path("out")});
  EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
}

TEST_F(SimCommand, FramesOptionReplacesTheScenes) {
  EXPECT_NE(sim(scene(50, 0.2, 0.2), {"--frames", "2", "--threads", "0"}).out.find("2 frames"), std::string::npos);
}

TEST_F(SimCommand, ABadSceneNamesFileAndLine) {
  const auto run = sim("[time]\nframes = 3\nframse = 4\n");
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("scene.toml:3: time: unknown key \"framse\""), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(SimCommand, AnUnstableStepNamesFileAndLine) {
  std::string text = scene(1, 0.2, 0.2);
  text.insert(text.find("max_step_s"), "dynamics_step_s = 0.0333\n");
  const auto run = sim(text);
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("scene.toml:3: time: dynamics_step_s = 0.0333 is not stable"), std::string::npos) << run.err;
}

TEST_F(SimCommand, WhatShowsOnlyInTheWorldNamesFileAndLineToo) {
  spit(path("face.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  spit(path("flat.obj"), "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  spit(path("loose.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n");
  spit(path("far.obj"), "v 0 0 0\nv 0 1 0\nv 0 -1e100 1\nf 1 2 3\n");
  const std::string cloth = "[time]\nframes = 1\n[[cloth]]\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n";
  const std::string sheet = "sheet = {nx = 2, ny = 2, width_m = 1, height_m = 1}\n";
  const struct {
    std::string text;
    int line, exit_code;
    std::string words;
  } kBad[] = {
      {"mesh = {file = \"absent.obj\"}\n", 6, 4, "mesh: " + path("absent.obj") + ": cannot open"},
      {"mesh = {file = \"far.obj\"}\n", 6, 3, "mesh: vertex 2 of far.obj has the coordinate -1e+100"},
      {"mesh = {file = \"face.obj\", scale = 1e10}\n", 6, 3, "beyond 1e+09 m; lower scale"},
      {sheet + "[[body]]\nmesh = {file = \"face.obj\", scale = 1e30}\n", 8, 3, "mesh: vertex 1 of face.obj"},
      {"mesh = {file = \"face.obj\"}\n[[cloth.pin]]\nvertices = [7]\n", 8, 3, "holds vertex 7, but its cloth has 3"},
      {"[cloth.garment]\ncell_m = 0.1\n"
       "ring = [{height_m = 2, depth_m = 1, width_m = 1}, {height_m = 1, depth_m = 1, width_m = 1}]\n"
       "sleeves = {top_m = 3, bottom_m = 2.5, depth_m = 0.3, length_m = 1, cuff_radius_m = 0.1}\n",
       9, 3, "the sleeves leave no cloth"},
      {sheet + "[[cloth]]\nname = \"stiff\"\nposition_m = [0, 0, 1]\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n" + sheet +
           "shear_n_m = 1e20\n",
       13, 3, "\"stiff\": its springs are stable below steps of "},
      {"mesh = {file = \"flat.obj\"}\n", 3, 3, "\"cloth\" has no mass"},
      {sheet + "thickness_m = 4.1\n", 7, 3, "is 4.1 m thick, more than 4 of its edges of 1 m"},
      {"mesh = {file = \"flat.obj\"}\nmasses = \"area\"\n", 7, 3, "give its faces an area"},
      {"mesh = {file = \"loose.obj\"}\nmasses = \"area\"\n", 7, 3, "or use masses = \"equal\""},
  };
  for (const auto& bad : kBad) {
    const auto run = sim(cloth + bad.text);
    EXPECT_EQ(run.exit_code, bad.exit_code) << bad.words << ": " << run.err;
    EXPECT_NE(run.err.find("scene.toml:" + std::to_string(bad.line) + ": "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(bad.words), std::string::npos) << run.err;
  }
}

TEST_F(SimCommand, WhatRepelsIsNear) {
  ASSERT_EQ(sim(scene(6, 0.2, 0.2)).exit_code, 0);
  const auto run = nlohmann::json::parse(slurp(path("out") + "/run.json"));
  EXPECT_GT(run["repulsions"], 0);
  EXPECT_GE(run["proximities"], run["repulsions"]) << "a contact repels at most once a step";
}

TEST_F(SimCommand, AnIntersectingStartIsRefusedWithAWitness) {
  const auto run = sim(scene(3, 0.3, 0.3));
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("\"sheet\""), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("\"ball\""), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(" of \"sheet\" and face "), std::string::npos) << "the pairs: " << run.err;
  EXPECT_NE(run.err.find("--repair"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(SimCommand, ClothThatStartsInsideAClosedBodyIsSaidToOnce) {
  const std::string words = "starts inside the closed body";
  const auto start = [&](const std::string& bodies, const std::string& cloth_position,
                         std::vector<std::string> options = {}) {
    options.insert(options.end(), {"--frames", "1"});
    return sim(
        "[time]\nframes = 2\n[[cloth]]\nname = \"sheet\"\nsheet = {nx = 3, ny = 3, width_m = 0.2, height_m = "
        "0.2}\nposition_m = " +
            cloth_position + "\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n" + bodies,
        options);
  };
  const std::string ball = "[[body]]\nname = \"ball\"\nsphere = {radius_m = 0.5, subdivisions = 2}\n";
  const auto inside = start(ball, "[0, 0, 0]");
  EXPECT_EQ(inside.exit_code, 0) << inside.err;
  EXPECT_NE(inside.err.find("selvage: note: \"sheet\" " + words + " \"ball\" without meeting it"), std::string::npos)
      << inside.err;
  std::filesystem::remove_all(path("out"));
  const auto nested = start(ball + "[[body]]\nname = \"stone\"\nsphere = {radius_m = 0.05}\n", "[0, 0, 0.2]");
  EXPECT_EQ(nested.exit_code, 0) << nested.err;
  EXPECT_EQ(nested.err.find("\"stone\""), std::string::npos) << "a body may be anywhere: " << nested.err;
  std::filesystem::remove_all(path("out"));
  ASSERT_EQ(start(ball, "[0, 0, 0]").exit_code, 0);
  const auto resumed = start(ball, "[0, 0, 0]", {"--resume"});
  EXPECT_EQ(resumed.exit_code, 0);
  EXPECT_EQ(resumed.err.find(words), std::string::npos) << "said at the start: " << resumed.err;
  // In a corner of the ball's box, and beside it.
  for (const char* place : {"[0.38, 0.38, 0.38]", "[0, 0, 2]"}) {
    std::filesystem::remove_all(path("out"));
    const auto outside = start(ball, place);
    EXPECT_EQ(outside.exit_code, 0) << outside.err;
    EXPECT_EQ(outside.err.find(words), std::string::npos) << outside.err;
  }
  // An octahedron, then without one of its faces.
  const std::string corners = "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n";
  const std::string faces = "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\n";
  for (const bool is_closed : {true, false}) {
    std::filesystem::remove_all(path("out"));
    spit(path("body.obj"), corners + faces + (is_closed ? "f 1 4 6\n" : ""));
    const auto run = start("[[body]]\nname = \"tent\"\nmesh = {file = \"body.obj\"}\n", "[0, 0, 0.1]");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err.find(words) != std::string::npos, is_closed) << run.err;
  }
}

TEST_F(SimCommand, OfClothInPartsItIsSaidHowManyStartInside) {
  // Two leaves and two stones, of one mesh each: one leaf is in the first stone, and in the box alone of the second.
  spit(path("leaves.obj"), "v 0 0 0\nv .1 0 0\nv 0 .1 0\nf 1 2 3\nv 5 0 0\nv 5.1 0 0\nv 5 .1 0\nf 4 5 6\n");
  spit(path("stones.obj"),
       "v -1 -1 -1\nv 3 -1 -1\nv -1 3 -1\nv -1 -1 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
       "v 4 4 4\nv 4 4 -3\nv 4 -3 4\nv -3 4 4\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n");
  const auto run =
      sim("[time]\nframes = 1\n[[cloth]]\nname = \"leaves\"\nmesh = {file = \"leaves.obj\"}\n"
          "density_kg_m2 = 0.2\nstretch_n_m = 40\n[[body]]\nname = \"stones\"\nmesh = {file = "
          "\"stones.obj\"}\n");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("note: 1 of 2 connected parts of \"leaves\" starts inside the closed body \"stones\""),
            std::string::npos)
      << run.err;
}

TEST_F(SimCommand, AStartThatFloat32RoundsTogetherSaysSo) {
  const std::string far =
      "[time]\nframes = 1\n[collision]\nthickness_m = 5e-3\n%[[cloth]]\nsheet = {nx = 30, ny = 30, width_m = 1, "
      "height_m = 1}\nposition_m = [1e7, 1e7, 1e7]\nrotation_deg = [0, 0, 10]\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n";
  const std::size_t at = far.find('%');
  const auto rounded = sim(far.substr(0, at) + "precision = \"float32\"\n" + far.substr(at + 1));
  EXPECT_EQ(rounded.exit_code, 3);
  EXPECT_NE(rounded.err.find("rounded to float32"), std::string::npos) << rounded.err;
  EXPECT_EQ(sim(far.substr(0, at) + far.substr(at + 1)).exit_code, 0);
}

TEST_F(SimCommand, AMeshThatNoRepairCanFreeSaysWhatIsWrongWithIt) {
  struct Case {
    const char* faces;
    const char* message;
    bool is_asked_to_repair = false;
  };
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const auto& [faces, message, is_asked_to_repair] :
       {Case{"f 1 2 3\nf 1 2 5\n", "take the faces without area out of the mesh"},
        {"f 1 2 3\nf 2 4 6\n", "take the faces without area out of the mesh"},
        {"f 1 2 3\nf 2 4 6\n", "take the faces without area out of the mesh", true},
        {"f 1 2 3\nf 2 4 3\nf 3 1 2\n", "faces 0 and 2 have the same corners: take one of them out of the mesh"},
        {"f 1 2 3\nf 6 4 7\n",
         "; 4 of their vertices lie where another one lies: along a seam, export one for both"}}) {
    spit(path("cloth.obj"), vertices + faces);
    const auto run =
        sim("[time]\nframes = 1\n[[cloth]]\nmesh = {file = \"cloth.obj\"}\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n",
            is_asked_to_repair ? std::vector<std::string>{"--repair"} : std::vector<std::string>{});
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
  }
}

TEST_F(SimCommand, AnIntersectingStartIsRepairedWhereThatIsAskedFor) {
  const auto run = sim(scene(4, 0.27, 0.27), {"--repair", "--record", "steps"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("repair     "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(" of 100 cloth vertices moved, by at most 0.0"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(" steps drew together what was stretched, largest strain 0.0"), std::string::npos) << run.err;
  EXPECT_EQ(run_program(folder_, {"verify", path("out")}).exit_code, 0);
  const auto told = nlohmann::json::parse(slurp(path("out") + "/run.json"));
  EXPECT_GT(told["repaired_pairs"], 0);
  EXPECT_GT(told["repaired_vertices"], 0);
  EXPECT_GT(told["largest_repair_m"], 0);

  // The repair does the same again when the run is resumed.
  std::filesystem::rename(path("out"), path("whole"));
  ASSERT_EQ(sim(scene(4, 0.27, 0.27), {"--repair", "--frames", "2"}).exit_code, 0);
  const auto resumed = sim(scene(4, 0.27, 0.27), {"--repair", "--resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(nlohmann::json::parse(slurp(path("out") + "/run.json"))["largest_repair_m"], told["largest_repair_m"]);
  std::filesystem::rename(path("out"), path("parts"));
  ASSERT_EQ(sim(scene(4, 0.27, 0.27), {"--repair"}).exit_code, 0);
  for (const char* name : {"/frame_000000.npy", "/frame_000004.npy"}) {
    EXPECT_EQ(slurp(path("parts") + name), slurp(path("out") + name)) << name;
    EXPECT_FALSE(slurp(path("out") + name).empty()) << name;
  }
}

TEST_F(SimCommand, ABodyThatWaitedIsNamedWithTimesAndLag) {
  const auto run = sim(testing::squeeze_scene_text("yield", "0.03"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto at = run.out.find("\"hammer\" waited in ");
  ASSERT_NE(at, std::string::npos) << run.out;
  int steps = 0;
  double begin_s = 0, end_s = 0, lag_m = 0;
  ASSERT_EQ(std::sscanf(run.out.c_str() + at, "\"hammer\" waited in %d steps from %lf to %lf s, up to %lf m", &steps,
                        &begin_s, &end_s, &lag_m),
            4);
  EXPECT_GT(steps, 3);
  EXPECT_GT(begin_s, 0.1);
  EXPECT_GT(end_s, begin_s);
  // The script ends 10 mm lower than the sheet between the boxes, and its tolerance, leave room for.
  EXPECT_NEAR(lag_m, 0.01, 2e-3);
}

TEST_F(SimCommand, ARepairLeavesCleanClothBesideItAlone) {
  // Curved and flattened by its stabilisers: whatever moved it would show.
  std::string curved;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 2; ++j) curved += fmt::format("v {} {} {}\n", 5 + 0.05 * i, 0.1 * j, 0.01 * (i - 4) * (i - 4));
  }
  for (int i = 0; i < 8; ++i)
    curved += fmt::format("f {0} {2} {1}\nf {1} {2} {3}\n", 2 * i + 1, 2 * i + 2, 2 * i + 3, 2 * i + 4);
  spit(path("curved.obj"), curved);
  const auto run = sim(scene(1, 0.27, 0.27) +
                           "[[cloth]]\nname = \"bystander\"\nmesh = {file = \"curved.obj\"}\n"
                           "density_kg_m2 = 0.2\nstretch_n_m = 40\nstabilize_n_m = 5\n",
                       {"--repair"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_NE(run.err.find("repair     "), std::string::npos) << run.err;
  const auto sequence = io::open_sequence({path("out")});
  const io::MeshData start = sequence->frame(0), alone = io::read_mesh(path("curved.obj"));
  const auto group = std::ranges::find(start.groups, std::string("bystander"), &io::Group::name);
  ASSERT_NE(group, start.groups.end());
  const auto first = static_cast<std::size_t>(start.triangles[static_cast<std::size_t>(group->face_begin)][0]);
  const auto offset = first - static_cast<std::size_t>(alone.triangles[0][0]);
  for (std::size_t v = 0; v < alone.points.size(); ++v) EXPECT_EQ(start.points[offset + v], alone.points[v]) << v;
}

TEST_F(SimCommand, ARepairedRunGoesOnFromItsCheckpointWithoutAnotherRepair) {
  const std::string text = scene(3, 0.27, 0.27);
  ASSERT_EQ(sim(text, {"--repair"}).exit_code, 0);
  std::filesystem::rename(path("out"), path("whole"));
  const auto start = sim(text, {"--resume"});
  EXPECT_EQ(start.exit_code, 3) << "there is no checkpoint";
  EXPECT_NE(start.err.find("let --repair do it"), std::string::npos) << start.err;

  ASSERT_EQ(sim(text, {"--repair", "--frames", "1"}).exit_code, 0);
  const std::string checkpoint = path("out") + "/checkpoint.bin", bytes = slurp(checkpoint);
  spit(checkpoint, bytes.substr(0, bytes.size() / 2));
  const auto damaged = sim(text, {"--resume"});
  EXPECT_EQ(damaged.exit_code, 3);
  EXPECT_NE(damaged.err.find("the checkpoint is "), std::string::npos) << damaged.err;
  spit(checkpoint, bytes);
  const auto foreign = sim(scene(3, 0.28, 0.28), {"--resume"});
  EXPECT_EQ(foreign.exit_code, 3);
  EXPECT_NE(foreign.err.find("belongs to another scene"), std::string::npos) << foreign.err;

  const auto resumed = sim(text, {"--resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(slurp(path("out") + "/frame_000003.npy"), slurp(path("whole") + "/frame_000003.npy"));
  const auto told = nlohmann::json::parse(slurp(path("out") + "/run.json"));
  EXPECT_GT(told["repaired_pairs"], 0);
  EXPECT_EQ(told["largest_repair_m"], nlohmann::json::parse(slurp(path("whole") + "/run.json"))["largest_repair_m"]);
}

TEST_F(SimCommand, ARepairThatIsNotPossibleSaysWhatRemainsAndWritesNothing) {
  // The middle of the sheet is pinned inside the ball.
  std::string text = scene(3, 0.3, 0.3);
  text.insert(text.find("[[body]]"), "[[cloth.pin]]\nvertices = [44, 45, 54, 55]\n");
  const auto run = sim(text, {"--repair"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("--repair found no way out"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(" of \"sheet\" and face "), std::string::npos) << "the pairs: " << run.err;
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(SimCommand, SqueezedClothStopsTheRunOrTheBodiesWait) {
  // The ball rises until it overlaps the lid by 4 cm, with the sheet between them.
  const auto stopped = sim(scene(6, 0.2, 0.34));
  EXPECT_EQ(stopped.exit_code, 1);
  EXPECT_NE(stopped.err.find("stopped at"), std::string::npos) << stopped.err;
  EXPECT_NE(stopped.err.find("(sheet)"), std::string::npos) << stopped.err;
  const auto end = nlohmann::json::parse(slurp(path("out") + "/run.json"));
  EXPECT_EQ(end["end"], "stopped");
  EXPECT_EQ(end["exit_code"], 1);
  EXPECT_EQ(run_program(folder_, {"verify", "--frames-only", path("out")}).exit_code, 0);

  std::filesystem::remove_all(path("out"));
  EXPECT_EQ(sim("squeeze = \"yield\"\n" + scene(6, 0.2, 0.34), {"--record", "steps"}).exit_code, 0);
  EXPECT_EQ(run_program(folder_, {"verify", path("out")}).exit_code, 0);

  std::filesystem::remove_all(path("out"));
  const auto strict = sim("squeeze = \"yield\"\n" + scene(6, 0.2, 0.34), {"--strict"});
  EXPECT_EQ(strict.exit_code, 1);
  EXPECT_NE(strict.err.find("a body waited"), std::string::npos) << strict.err;
  const auto told = nlohmann::json::parse(slurp(path("out") + "/run.json"));
  EXPECT_EQ(told["end"], "complete") << "all was written";
  EXPECT_EQ(told["exit_code"], 1);
}

TEST_F(SimCommand, AnInterruptedRunExits75AndResumesWithTheSameBits) {
  spit(path("scene.toml"), scene(40, 0.2, 0.2));
  ASSERT_EQ(run_program(folder_, {"sim", path("scene.toml"), "-o", path("whole")}).exit_code, 0);

  const pid_t child = testing::start_program(folder_.path(), {"sim", path("scene.toml"), "-o", path("out")});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!std::filesystem::exists(path("out") + "/frame_000003.npy") && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  kill(child, SIGTERM);
  const auto interrupted = testing::wait_for_program(folder_.path(), child);
  EXPECT_EQ(interrupted.exit_code, 75);
  EXPECT_NE(interrupted.err.find("selvage: interrupted; go on with --resume\n"), std::string::npos) << interrupted.err;
  ASSERT_FALSE(std::filesystem::exists(path("out") + "/frame_000040.npy")) << "it was not interrupted";

  const auto resumed = run_program(folder_, {"sim", path("scene.toml"), "-o", path("out"), "--resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find("resumed"), std::string::npos);
  for (int frame = 0; frame <= 40; ++frame) {
    const std::string name = "/frame_0000" + std::string(frame < 10 ? "0" : "") + std::to_string(frame) + ".npy";
    EXPECT_EQ(slurp(path("out") + name), slurp(path("whole") + name)) << name;
    EXPECT_FALSE(slurp(path("out") + name).empty()) << name;
  }
}

namespace {

/// Frames and their list; run.json and the checkpoint hold seconds, which differ.
std::map<std::string, std::string> recorded(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != "run.json" && name != "checkpoint.bin") files[name] = slurp(entry.path());
  }
  return files;
}

}  // namespace

TEST_F(SimCommand, ARunKilledAtRandomMomentsResumesWithTheSameBits) {
  // S5. SELVAGE_KILLS=50 is the long form. A run is killed until it is done, then begun again.
  const char* asked = std::getenv("SELVAGE_KILLS");
  const int kills = asked != nullptr ? std::stoi(asked) : 4;
  using Clock = std::chrono::steady_clock;
  for (const std::string solver : {"explicit", "implicit"}) {
    spit(path("scene.toml"), "solver = \"" + solver + "\"\n" + scene(8, 0.2, 0.2));
    const std::vector<std::string> whole = {"sim", path("scene.toml"), "--record", "steps", "-o", path("whole")};
    const Clock::time_point start = Clock::now();
    ASSERT_EQ(run_program(folder_, whole).exit_code, 0);
    const std::chrono::duration<double> whole_s = Clock::now() - start;
    const auto expected = recorded(path("whole"));
    ASSERT_GT(expected.size(), 10u);
    const std::vector<std::string> resume = {"sim", path("scene.toml"), "--record", "steps",
                                             "-o",  path("out"),        "--resume"};
    std::mt19937 random(50);
    int killed = 0, resumed = 0;
    for (bool done = false; !done || killed < kills / 2;) {
      const pid_t child = testing::start_program(folder_.path(), resume);
      if (killed < kills / 2) {
        std::this_thread::sleep_for(whole_s * (double(random() % 1000) / 1000));
        kill(child, SIGKILL);
      }
      const auto run = testing::wait_for_program(folder_.path(), child);
      resumed += run.err.find("resumed") != std::string::npos ? 1 : 0;
      killed += run.exit_code == -1 ? 1 : 0;
      done = run.exit_code == 0;
      ASSERT_TRUE(done || run.exit_code == -1) << run.err;
      if (!done) continue;
      const auto ended = recorded(path("out"));
      EXPECT_EQ(ended.size(), expected.size()) << "files are missing or left over";
      for (const auto& [name, bytes] : ended) {
        ASSERT_TRUE(expected.count(name) == 1 && bytes == expected.at(name))
            << name << ", " << solver << ", after " << killed << " kills";
      }
      std::filesystem::remove_all(path("out"));
    }
    EXPECT_GT(resumed, 0) << "no run was killed late enough to have anything to resume";
    std::filesystem::remove_all(path("whole"));
  }
}

TEST_F(SimCommand, ADamagedRunIsNotResumed) {
  const auto resume = [&](const std::string& frames) {
    return sim(scene(5, 0.2, 0.2), {"--record", "steps", "--resume", "--frames", frames});
  };
  ASSERT_EQ(resume("3").exit_code, 0);
  const std::string frame = path("out") + "/frame_000001.npy", bytes = slurp(frame);
  const auto expect_refused = [&](const std::string& what) {
    const auto result = resume("5");
    EXPECT_EQ(result.exit_code, 3) << result.out;
    EXPECT_NE(result.err.find(frame + ": " + what), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("restore the file, or start again"), std::string::npos) << result.err;
  };
  spit(frame, "\n");
  expect_refused("the checksum differs");
  std::filesystem::remove(frame);
  expect_refused("is on the list and not there");
  spit(frame, bytes);
  EXPECT_EQ(resume("5").exit_code, 0);
}

TEST_F(SimCommand, ACheckpointOfAnotherSceneIsRefusedWithWhatDiffers) {
  const std::string
      text = scene(3, 0.2, 0.2),
      meshed =
          "[time]\nframes = 2\n[[cloth]]\nname = \"leaf\"\nmesh = {file = \"leaf.obj\"}\ndensity_kg_m2 = 0.2\n"
          "stretch_n_m = 40\n";
  ASSERT_EQ(sim(text, {"--frames", "1"}).exit_code, 0);
  const std::string ran = slurp(path("out") + "/run.json");
  const auto expect_refused = [&](const testing::ProgramResult& run, const std::string& words) {
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_NE(run.err.find("checkpoint.bin: the checkpoint belongs to another scene: " + words + "; resume with"),
              std::string::npos)
        << run.err;
  };
  std::string heavier = text;
  heavier.replace(heavier.find("= 0.3\n"), 5, "= 0.4");
  expect_refused(sim(heavier, {"--resume"}), "cloth[0].density_kg_m2 (line 10) was 0.3 and is 0.4");
  expect_refused(sim(text, {"--resume", "--quality", "full"}), "--quality was draft and is full");
  EXPECT_EQ(slurp(path("out") + "/run.json"), ran) << "a refusal is no end of a run";
  EXPECT_EQ(sim(text, {"--resume"}).exit_code, 0);

  std::filesystem::remove_all(path("out"));
  spit(path("leaf.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_EQ(sim(meshed, {"--frames", "1"}).exit_code, 0);
  spit(path("leaf.obj"), "v 0 0 0\nv 1 0 0\nv 0 1.5 0\nf 1 2 3\n");
  expect_refused(sim(meshed, {"--resume"}), "the file of \"leaf\" is not what it was");
}

TEST_F(SimCommand, ARunThatAnErrorEndsSaysSoInRunJson) {
  // A body whose last frame is needed after 10 s, and gone by then.
  for (int i = 0; i < 3; ++i) {
    spit(path("body_" + std::to_string(i) + ".obj"),
         fmt::format("v 0 0 {0}\nv 1 0 {0}\nv 0 1 {0}\nf 1 2 3\n", 0.01 * i));
  }
  spit(path("scene.toml"),
       "[time]\nframes = 400\n[[cloth]]\nsheet = {nx = 2, ny = 2, width_m = 1, height_m = 1}\nposition_m = [0, 0, 5]\n"
       "density_kg_m2 = 0.2\nstretch_n_m = 40\n[[body]]\nname = \"wave\"\n"
       "sequence = {file = \"body_*.obj\", frames_per_s = 0.1}\n");
  const std::vector<std::string> resume = {"sim", path("scene.toml"), "-o", path("out"), "--resume"};
  const pid_t child = testing::start_program(folder_.path(), resume);
  for (int i = 0; i < 6000 && !std::filesystem::exists(path("out") + "/frame_000001.npy"); ++i) usleep(1000);
  const std::string last = path("body_2.obj"), bytes = slurp(last);
  std::filesystem::remove(last);
  const auto failed = testing::wait_for_program(folder_.path(), child);
  EXPECT_EQ(failed.exit_code, 4) << failed.err;
  EXPECT_NE(failed.err.find("body_2.obj"), std::string::npos) << failed.err;
  auto told = nlohmann::json::parse(slurp(path("out") + "/run.json"));
  EXPECT_EQ(told["end"], "failed");
  EXPECT_EQ(told["exit_code"], 4);
  EXPECT_EQ("selvage: " + told["error"].get<std::string>() + "\n", failed.err.substr(failed.err.find("selvage: ")));
  const auto frames = std::ssize(recorded(path("out"))) - 4;  // without header, faces, list and the initial state
  EXPECT_EQ(told["frames"], frames);
  EXPECT_GE(frames, 300);
  EXPECT_LT(frames, 400);

  spit(last, bytes);
  const auto resumed = run_program(folder_, resume);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  told = nlohmann::json::parse(slurp(path("out") + "/run.json"));
  EXPECT_EQ(told["end"], "complete");
  EXPECT_EQ(told["exit_code"], 0);
  EXPECT_TRUE(told["error"].is_null());
  EXPECT_EQ(told["frames"], 400);
}

TEST_F(SimCommand, ARunWithoutRoomForItsFirstFrameSaysSoInRunJson) {
  spit(path("scene.toml"), scene(2, 0.2, 0.2));
  // 6 KiB: for 482 faces and for run.json, not for the 262 vertices of a frame.
  const std::string limited =
      "cd " + folder_.path().string() + " && ulimit -f 12 && exec " SELVAGE_PROGRAM " sim scene.toml -o out";
  const auto run = run_program(folder_, {"-c", limited}, "/bin/sh");
  EXPECT_EQ(run.exit_code, 4) << run.err;
  const auto told = nlohmann::json::parse(slurp(path("out") + "/run.json"));
  EXPECT_EQ(told["end"], "failed");
  EXPECT_EQ(told["exit_code"], 4);
  EXPECT_EQ(told["frames"], 0);
  EXPECT_NE(told["error"].get<std::string>().find("ulimit -f"), std::string::npos) << told;
}

TEST_F(SimCommand, NamesThatATerminalWouldObeyAreRefused) {
  for (const std::string name : {R"(x\u001b]0;title\u0007)", R"(x\u009b2J)", R"(two\nlines)"}) {
    std::string text = scene(1, 0.2, 0.2);
    text.replace(text.find("\"sheet\"") + 1, 5, name);
    const auto result = sim(text);
    EXPECT_EQ(result.exit_code, 3) << name;
    EXPECT_NE(result.err.find("scene.toml:7: cloth: name holds a control character"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find('\x1b'), std::string::npos);
  }
}

TEST_F(SimCommand, AFolderOfOtherFilesIsRefused) {
  const std::filesystem::path out = path("out");
  std::filesystem::create_directory(out);
  for (const char* name : {"thesis.txt", "frame_000000.npy"}) {
    spit(out / name, "mine");
    for (const std::vector<std::string>& options : {std::vector<std::string>{}, {"--resume"}}) {
      const auto refused = sim(scene(1, 0.2, 0.2), options);
      EXPECT_EQ(refused.exit_code, 4) << refused.out;
      const std::string words =
          out.string() + ": holds files that are no sequence (" + name + "); name an empty folder";
      EXPECT_NE(refused.err.find(words), std::string::npos) << refused.err;
    }
    EXPECT_EQ(slurp(out / name), "mine");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(out), {}), 1);
    std::filesystem::remove(out / name);
  }
  spit(out / "faces.npy", "of a run that was killed before its header");
  EXPECT_EQ(sim(scene(1, 0.2, 0.2)).exit_code, 0);
  spit(out / "thesis.txt", "beside a sequence");
  EXPECT_EQ(sim(scene(1, 0.2, 0.2), {"--resume"}).exit_code, 0);
}

TEST_F(SimCommand, ASecondRunDoesNotOverwriteTheFirst) {
  EXPECT_EQ(sim(scene(1, 0.2, 0.2)).exit_code, 0);
  const std::string before = slurp(path("out") + "/frame_000001.npy");
  EXPECT_EQ(sim(scene(2, 0.2, 0.2)).exit_code, 4);
  EXPECT_EQ(slurp(path("out") + "/frame_000001.npy"), before);
}

}  // namespace selvage
