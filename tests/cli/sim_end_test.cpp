// How runs of `selvage sim` end, and go on.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/sim_runs.h"
#include "tests/squeeze_scene.h"

namespace selvage {

using testing::run_program;
using testing::scene;
using testing::SimCommand;
using testing::slurp;
using testing::spit;

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

TEST_F(SimCommand, WhoWaitedBeforeAKillIsNamedAfterIt) {
  const std::string text = testing::squeeze_scene_text("yield", "0.03");
  const auto last_line = [](const std::string& out) { return out.substr(out.find("\"hammer\" waited in ")); };
  const auto whole = sim(text);
  const auto waits = nlohmann::json::parse(slurp(path("out/run.json"))).at("waits");
  ASSERT_EQ(waits.size(), 1U);
  EXPECT_EQ(waits[0].at("name"), "hammer");
  std::filesystem::remove_all(path("out"));
  EXPECT_EQ(sim(text, {"--frames", "7"}).exit_code, 0);
  const auto before = nlohmann::json::parse(slurp(path("out/run.json"))).at("waits");
  ASSERT_EQ(before.size(), 1U) << "it waits on both sides";
  EXPECT_LT(before[0].at("steps"), waits[0].at("steps"));
  const auto resumed = sim(text, {"--resume"});
  EXPECT_EQ(last_line(resumed.out), last_line(whole.out));
  EXPECT_EQ(nlohmann::json::parse(slurp(path("out/run.json"))).at("waits"), waits);
}

TEST_F(SimCommand, SolvesThatDoNotConvergeAreNotedAndStrictCountsThem) {
  const auto over_a_ball = [](const std::string& velocity_m_s) {
    return "solver = \"implicit\"\n[time]\nframes_per_s = 5\nframes = 1\nmax_step_s = 0.2\nmin_step_s = 0.2\n"
           "[[cloth]]\nsheet = {nx = 4, ny = 4, width_m = 0.4, height_m = 0.4}\ndensity_kg_m2 = 0.2\nshear_n_m = 1e3\n"
           "stretch_n_m = 1e9\nposition_m = [0.02, 0.03, 0.28]\nvelocity_m_s = " +
           velocity_m_s + "\n[[body]]\nsphere = {radius_m = 0.25, subdivisions = 2}\n";
  };
  const auto solved = sim(over_a_ball("[0, 0, 0]"), {"--strict"});
  EXPECT_EQ(solved.exit_code, 0) << solved.err;
  EXPECT_EQ(solved.err.find("did not converge"), std::string::npos) << solved.err;
  std::filesystem::remove_all(path("out"));
  const auto unsolved = sim(over_a_ball("[5, 0, -10]"));
  EXPECT_EQ(unsolved.exit_code, 0) << unsolved.err;
  EXPECT_NE(unsolved.err.find("note: 1 of 1 implicit solves did not converge"), std::string::npos) << unsolved.err;
  std::filesystem::remove_all(path("out"));
  EXPECT_EQ(sim(over_a_ball("[5, 0, -10]"), {"--strict"}).exit_code, 1);
}

TEST_F(SimCommand, StepsTooLongForABodyThatTurnsAreNotedAndStrictCountsThem) {
  const auto over_a_blade = [](const std::string& min_step) {
    return "[time]\nframes = 1\n" + min_step +
           "[[cloth]]\nsheet = {nx = 4, ny = 4, width_m = 0.1, height_m = 0.1}\nposition_m = [0.5, 0, 0.16]\n"
           "density_kg_m2 = 0.2\nstretch_n_m = 60\n[[body]]\nbox = {size_m = [2, 0.05, 0.3]}\n"
           "key = [{time_s = 0}, {time_s = 1, rotation_deg = [0, 0, 10800]}]\n";
  };
  const auto followed = sim(over_a_blade(""), {"--strict"});
  EXPECT_EQ(followed.exit_code, 0) << followed.err;
  EXPECT_EQ(followed.err.find("too long"), std::string::npos) << followed.err;
  std::filesystem::remove_all(path("out"));
  const auto noted = sim(over_a_blade("min_step_s = 0.03\n"));
  EXPECT_EQ(noted.exit_code, 0) << noted.err;
  EXPECT_NE(noted.err.find("note: 1 steps were too long for a body that turns"), std::string::npos) << noted.err;
  EXPECT_EQ(nlohmann::json::parse(slurp(path("out") + "/run.json"))["bent_steps"], 1);
  std::filesystem::remove_all(path("out"));
  EXPECT_EQ(sim(over_a_blade("min_step_s = 0.03\n"), {"--strict"}).exit_code, 1);
  std::filesystem::remove_all(path("out"));
  EXPECT_EQ(sim(over_a_blade("min_step_s = 0.03\n"), {"--frames", "2"}).exit_code, 0);
  const auto resumed = sim(over_a_blade("min_step_s = 0.03\n"), {"--frames", "2", "--resume", "--strict"});
  EXPECT_EQ(resumed.exit_code, 1) << resumed.err;
}

TEST_F(SimCommand, SqueezedClothStopsTheRunOrTheBodiesWait) {
  // The ball rises until it overlaps the lid by 4 cm, with the sheet between them.
  const auto stopped = sim(scene(6, 0.2, 0.34));
  EXPECT_EQ(stopped.exit_code, 1);
  EXPECT_NE(stopped.err.find("stopped at"), std::string::npos) << stopped.err;
  EXPECT_NE(stopped.err.find("; ball cannot go on at ("), std::string::npos) << stopped.err;
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

TEST_F(SimCommand, PinsThatLeaveNoRoomAreNamed) {
  const auto run =
      sim("[time]\nframes = 10\n[[cloth]]\nsheet = {nx = 2, ny = 2, width_m = 1, height_m = 1}\ndensity_kg_m2 = 0.2\n"
          "stretch_n_m = 40\n[[cloth.pin]]\nedge = \"left\"\n"
          "key = [{time_s = 0}, {time_s = 0.1, position_m = [2, 0, 0]}]\n[[cloth.pin]]\nedge = \"right\"\n");
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_NE(run.err.find(" (cloth pin 0)"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(" (cloth pin 1)"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("move the pins apart"), std::string::npos) << run.err;
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
    // Beside other programs two runs in a row may be killed before they have written anything.
    const auto wants_more = [&] { return killed < kills / 2 || (resumed == 0 && killed < kills / 2 + 50); };
    for (bool done = false; !done || wants_more();) {
      const pid_t child = testing::start_program(folder_.path(), resume);
      if (wants_more()) {
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
  expect_refused(sim(meshed, {"--resume"}),
                 "the file of \"leaf\" is not what it was, or is read otherwise by this version");
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

}  // namespace selvage
