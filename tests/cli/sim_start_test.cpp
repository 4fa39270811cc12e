// States that a run of `selvage sim` cannot start from, and what --repair makes of them.
#include <algorithm>
#include <csignal>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/mesh_reader.h"
#include "io/sequence.h"
#include "tests/cli/sim_runs.h"

namespace selvage {

using testing::run_program;
using testing::scene;
using testing::SimCommand;
using testing::slurp;
using testing::spit;

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

TEST_F(SimCommand, OfPolygonsThatWereSplitItIsSaid) {
  spit(path("quad.obj"), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const auto run =
      sim("[time]\nframes = 1\n[[cloth]]\nmesh = {file = \"quad.obj\"}\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n"
          "[[body]]\nmesh = {file = \"quad.obj\"}\nposition_m = [0, 0, -1]\n");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::size_t note = run.err.find("selvage: note: quad.obj: 1 face has");
  EXPECT_NE(note, std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("quad.obj: 1 face has", note + 30), std::string::npos) << "once: " << run.err;
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

TEST_F(SimCommand, SeamsThatARepairOpensAreNamed) {
  spit(path("cloth.obj"),
       "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\n"
       "f 1 2 3\nf 5 4 6\n");
  const auto run =
      sim("[time]\nframes = 1\n[[cloth]]\nmesh = {file = \"cloth.obj\"}\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n",
          {"--repair"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("note       the mesh of \"cloth\" was split at seams, where 4 of these vertices lay at the "
                         "place of another; they are open now"),
            std::string::npos)
      << run.err;
}

TEST_F(SimCommand, AMeshThatNoRepairCanFreeSaysWhatIsWrongWithIt) {
  struct Case {
    const char* faces;
    std::string message;
    bool is_asked_to_repair = false;
  };
  const std::string seams = "the mesh of \"cloth\" is split at seams, where 4 of these vertices lie at the place of ";
  const std::string fan = "faces 0 and 1 go around one corner, as those of a polygon do";
  const std::string vertices =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 0 0\nv 1 0 0\nv 0 1 0\n"
      "v 0.2 0.2 0\n"
      "v 0.2 0.2 -1\nv 0.3 0.2 1\nv 0.2 0.3 1\n";
  for (const auto& [faces, message, is_asked_to_repair] :
       {Case{"f 1 2 3\nf 1 2 5\n", "take the faces without area out of the mesh"},
        {"f 1 2 3\nf 2 4 6\n", "take the faces without area out of the mesh"},
        {"f 1 2 3\nf 2 4 6\n", "take the faces without area out of the mesh", true},
        {"f 1 2 3\nf 2 4 3\nf 3 1 2\n", "faces 0 and 2 have the same corners: take one of them out of the mesh"},
        {"f 1 2 3\nf 6 4 7\n", seams +
                                   "another: weld them to one (merge by distance 0) in the program that wrote it, or "
                                   "have --repair open them"},
        {"f 2 8 3 1\n", fan},
        {"f 1 2 4\nf 1 5 3\n", "move them apart, or let --repair do it"},  // around one corner, without a common side
        {"f 1 2 3\nf 6 4 7\nf 9 10 11\n", seams},
        {"f 1 2 3\nf 6 4 7\nf 9 10 11\n", "wrote it; the others: move them apart, or let --repair do it"}}) {
    spit(path("cloth.obj"), vertices + faces);
    const auto run =
        sim("[time]\nframes = 1\n[[cloth]]\nmesh = {file = \"cloth.obj\"}\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n",
            is_asked_to_repair ? std::vector<std::string>{"--repair"} : std::vector<std::string>{});
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(path("out")));
  }
}

// Its shape is another one now, which whoever drew it has to know.
TEST_F(SimCommand, APolygonThatARepairLaysOutOtherwiseIsNamed) {
  spit(path("cloth.obj"), "v 1 0 0\nv 0.2 0.2 0\nv 0 1 0\nv 0 0 0\nf 1 2 3 4\n");
  const auto run =
      sim("[time]\nframes = 1\n[[cloth]]\nmesh = {file = \"cloth.obj\"}\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n",
          {"--repair"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("note       faces 0 and 1 go around one corner"), std::string::npos) << run.err;
}

TEST_F(SimCommand, TwoClothsThatTouchAtTheirVerticesAreNoSplitMesh) {
  spit(path("left.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  spit(path("right.obj"), "v 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n");
  std::string text = "[time]\nframes = 1\n";
  for (const char* name : {"left", "right"}) {
    text += fmt::format(
        "[[cloth]]\nname = \"{0}\"\nmesh = {{file = \"{0}.obj\"}}\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n", name);
  }
  const auto run = sim(text);
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_NE(run.err.find("the first of \"left\" and \"right\"; move them apart, or let --repair do it\n"),
            std::string::npos)
      << run.err;
}

// Twelve cloths at one place.
TEST_F(SimCommand, OfAStartWithMorePairsThanAreLookedForItIsSaid) {
  std::string text = "[time]\nframes = 1\n";
  for (int i = 0; i < 12; ++i) {
    text += fmt::format(
        "[[cloth]]\nname = \"cloth {}\"\nsheet = {{nx = 13, ny = 13, width_m = 1, height_m = 1}}\n"
        "density_kg_m2 = 0.2\nstretch_n_m = 40\n",
        i);
  }
  for (const bool repairs : {false, true}) {
    const auto run = sim(text, repairs ? std::vector<std::string>{"--repair"} : std::vector<std::string>{});
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_NE(run.err.find("the start has at least 200000 intersecting pairs, the first of \"cloth "),
              std::string::npos)
        << run.err;
    EXPECT_NE(run.err.find("  and at least 199990 pairs more\n"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("move them apart, or let --repair do it"), std::string::npos) << run.err;
    EXPECT_EQ(run.err.find("that is more than --repair looks at") != std::string::npos, repairs) << run.err;
    EXPECT_FALSE(std::filesystem::exists(path("out")));
  }
}

TEST_F(SimCommand, TheCheckOfAStartCanBeInterrupted) {
  std::string text;  // all faces meet all others
  constexpr int kSide = 60;
  for (int i = 0; i < kSide * kSide; ++i)
    text += fmt::format("v {} {} {}\n", i * 7919 % 1009, i * 104729 % 1013, i * 31 % 997);
  for (int j = 0; j + 1 < kSide; ++j) {
    for (int i = 1; i < kSide; ++i)
      text += fmt::format("f {} {} {}\n", j * kSide + i, j * kSide + i + 1, (j + 1) * kSide + i);
  }
  spit(path("scrambled.obj"), text);
  spit(path("scene.toml"),
       "[time]\nframes_per_s = 24\nframes = 1\n[collision]\nthickness_m = 0.001\n[[cloth]]\nname = \"a\"\nmesh = {file "
       "= "
       "\"scrambled.obj\"}\ndensity_kg_m2 = 0.2\nstretch_n_m = 60\n");
  const pid_t child =
      testing::start_program(folder_.path(), {"sim", path("scene.toml"), "-o", path("out"), "--threads", "1"});
  testing::wait_until_signal_is_caught(child, SIGTERM);
  kill(child, SIGTERM);
  const auto run = testing::wait_for_program(folder_.path(), child);
  EXPECT_EQ(run.exit_code, 75) << run.err;
  EXPECT_NE(run.err.find("nothing was written"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(SimCommand, AnIntersectingStartIsRepairedWhereThatIsAskedFor) {
  const auto run = sim(scene(4, 0.27, 0.27), {"--repair", "--record", "steps"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.err.find("repair     "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(" of 100 cloth vertices moved, by at most 0.0"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(" steps eased what was strained, largest strain 0.0"), std::string::npos) << run.err;
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

}  // namespace selvage
