#include <filesystem>
#include <regex>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/sequence.h"
#include "tests/cli/sim_runs.h"

namespace selvage {

using testing::run_program;
using testing::scene;
using testing::SimCommand;
using testing::slurp;
using testing::spit;

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

TEST_F(SimCommand, ARunThatDidNotComeToItsEndIsNotedByTheChecker) {
  ASSERT_EQ(sim(scene(2, 0.1, 0.1)).exit_code, 0);
  const auto verify = [&] { return run_program(folder_, {"verify", path("out")}); };
  EXPECT_EQ(verify().err.find("did not come to its end"), std::string::npos);
  const std::string file = path("out") + "/run.json";
  std::string run = slurp(file);
  const std::string end = "\"complete\"";
  spit(file, run.replace(run.find(end), end.size(), "\"interrupted\""));
  EXPECT_NE(verify().err.find("did not come to its end (interrupted)"), std::string::npos);
  std::filesystem::remove(file);
  const auto cut = verify();
  EXPECT_NE(cut.err.find("did not come to its end (it was cut off, or goes on)"), std::string::npos) << cut.err;
  EXPECT_EQ(cut.exit_code, 0);
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

TEST_F(SimCommand, NamesThatATerminalWouldObeyAreRefused) {
  for (const std::string name : {R"(x\u001b]0;title\u0007)", R"(x\u009b2J)", R"(two\nlines)", R"(gnp.\u202etxt)",
                                 R"(a\u2069)", R"(two\u2028lines)"}) {
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

TEST_F(SimCommand, ARunThatGoesOnTakesNoFrameAway) {
  EXPECT_EQ(sim(scene(2, 0.2, 0.2)).exit_code, 0);
  const auto shorter = sim(scene(2, 0.2, 0.2), {"--resume", "--frames", "1"});
  EXPECT_EQ(shorter.exit_code, 0) << shorter.err;
  EXPECT_NE(shorter.err.find("simulated to frame 2 already; --frames 1 takes nothing away"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(path("out") + "/frame_000002.npy"));
}

TEST_F(SimCommand, ARunGoesOnAsItWasStarted) {
  const std::string text = scene(2, 0.2, 0.2);
  EXPECT_EQ(sim(text, {"--record", "steps", "--frames", "1"}).exit_code, 0);
  const auto refused = [&](const std::string& now, std::vector<std::string> options, const std::string& words) {
    options.emplace_back("--resume");
    const auto result = sim(now, options);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
  };
  refused(text, {"--record", "frames"},
          "holds every step, and frames alone are to follow; resume what was started here");
  std::string other = text;
  refused(other.replace(other.find("nx = 10"), 7, "nx = 11"), {}, "cloth[0].sheet.nx (line 8) was 10 and is 11");
  other = text;
  refused(other.replace(other.find("\"lid\""), 5, "\"top\""), {}, "body[1].name (line 23) was 'lid' and is 'top'");
  const auto result = sim("# with a comment\n" + text, {"--resume"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(io::open_sequence({path("out")})->kind(), io::SequenceKind::kSteps);
}

TEST_F(SimCommand, ASecondRunDoesNotOverwriteTheFirst) {
  EXPECT_EQ(sim(scene(1, 0.2, 0.2)).exit_code, 0);
  const std::string before = slurp(path("out") + "/frame_000001.npy");
  EXPECT_EQ(sim(scene(2, 0.2, 0.2)).exit_code, 4);
  EXPECT_EQ(slurp(path("out") + "/frame_000001.npy"), before);
}

}  // namespace selvage
