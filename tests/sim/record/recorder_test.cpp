#include "sim/record/recorder.h"

#include <chrono>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "io/sequence.h"
#include "sim/record/checkpoint.h"
#include "tests/sim/small_scene.h"

namespace selvage {

using namespace sim;
using testing::slurp;
using testing::small_scene_text;
using testing::TemporaryFolder;

namespace {

constexpr int kFrames = 8;
const char* const kProducer = "test";

bool same_bits(const io::Points& points, const Positions& x) {
  return points.size() == static_cast<std::size_t>(x.rows()) &&
         std::memcmp(points.data(), x.data(), points.size() * sizeof(points[0])) == 0;
}

// Steps until `frames` whole frames are done, or `step_limit` steps; finishes the recording only if asked to.
void run(Simulation& simulation, Recorder& recorder, std::int64_t frames, int step_limit = 1 << 20) {
  while (simulation.clock().frame() < frames && step_limit-- > 0) {
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, StepStatus::kSafe);
    recorder.record(step);
  }
}

class RecorderTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  Scene scene_ = testing::write_and_read_scene(folder_.path() / "small.toml", small_scene_text(kFrames));
};

}  // namespace

TEST(RunTotals, AreAllOfThemInRunJsonAndInCheckpoints) {
  RunTotals totals;
  std::size_t bytes = 0;
  for_each_total(totals, [&](const char*, const auto& field) { bytes += sizeof field; });
  EXPECT_EQ(bytes, sizeof totals) << "a field that is not visited is lost when a run is resumed";
}

TEST_F(RecorderTest, KeepsTheWholeClockInCheckpoints) {
  Checkpoint written;
  written.state.clock = {.frame = 1, .tick = 2, .level = 3, .good_steps = 4, .good_steps_asked = 5, .on_trial = 6};
  const std::filesystem::path file = folder_.path() / "checkpoint.bin";
  write_checkpoint(file, written);
  const auto read = read_checkpoint(file);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->state.clock, written.state.clock);
}

TEST_F(RecorderTest, KeepsTheStateInCheckpoints) {
  Simulation simulation(scene_);
  while (simulation.state().loads.vf.empty() || simulation.state().pressed.ee.empty()) {
    ASSERT_LT(simulation.clock().frame(), 30);
    (void)simulation.step();
  }
  Checkpoint written;
  written.state = simulation.state();
  written.state.blocked = {{{.body = 3, .vertex = 5, .at_m = {0.5, -2, 1e-9}, .direction = {0.6, 0, 0.8}}, 0.25, 1e-3}};
  const SimulationState& state = written.state;
  const std::filesystem::path file = folder_.path() / "checkpoint.bin";
  write_checkpoint(file, written);
  const auto read = read_checkpoint(file);
  ASSERT_TRUE(read.has_value());
  Simulation resumed(scene_);
  resumed.restore(read->state);
  for (const SimulationState& kept : {read->state, resumed.state()}) {
    EXPECT_EQ(kept.x, state.x);
    EXPECT_EQ(kept.v, state.v);
    EXPECT_EQ(kept.clock, state.clock);
    EXPECT_EQ(kept.loads, state.loads);
    EXPECT_EQ(kept.pressed, state.pressed);
    EXPECT_EQ(kept.blocked, state.blocked);
  }
}

TEST_F(RecorderTest, KeepsInCheckpointsOfWhatSceneTheyAre) {
  const std::filesystem::path file = folder_.path() / "checkpoint.bin";
  for (const Quality quality : {Quality::kDraft, Quality::kFull}) {
    Checkpoint written;
    written.scene = {"[time]\nframes = 3\n", quality, {1, 2, 3}, 4};
    write_checkpoint(file, written);
    EXPECT_EQ(read_checkpoint(file)->scene, written.scene);
  }
}

TEST_F(RecorderTest, ASceneIsIdentifiedByAllThatDeterminesIt) {
  const World world = build_world(scene_);
  const SceneIdentity same = identify(scene_, world);
  EXPECT_EQ(same, identify(scene_, build_world(scene_)));
  EXPECT_EQ(first_difference(same, same, world), std::nullopt);
  EXPECT_EQ(same.parts.size(), 3U);
  const auto expect_other = [&](const World& other, const std::string& words) {
    const SceneIdentity now = identify(scene_, other);
    EXPECT_NE(now, same) << words;
    EXPECT_NE(fingerprint_of(now), fingerprint_of(same)) << words;
    EXPECT_EQ(first_difference(same, now, other), words);
  };
  World moved = world;
  moved.x_t0(world.triangles[static_cast<std::size_t>(world.groups[1].face_begin)][0], 2) += 1e-9;
  expect_other(moved, "the file of \"ball\" is not what it was, or is read otherwise by this version");
  World turned = world;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  expect_other(turned, "the file of \"sheet\" is not what it was, or is read otherwise by this version");
  World faster = world;
  faster.v_t0(0, 0) += 1e-9;
  expect_other(faster, "one of the mesh files is not what it was");
  SceneIdentity full = same;
  full.quality = Quality::kFull;
  EXPECT_NE(fingerprint_of(full), fingerprint_of(same));
  EXPECT_EQ(first_difference(same, full, world), "--quality was draft and is full");
}

TEST_F(RecorderTest, AFailedRunSaysWhyAndGoesOnFromTheLastWholeFrame) {
  const auto output = folder_.path() / "out";
  Simulation simulation(scene_);
  {
    Recorder recorder(output, simulation, io::SequenceKind::kFrames, false, kProducer);
    recorder.begin();
    run(simulation, recorder, 2);
    // Advanced, and not recorded: as where the disk is full.
    while (simulation.clock().frame() < 3) (void)simulation.step();
    recorder.finish({RunEnd::kFailed, 4, "C:\\run: cannot \"write\"\nit"});
  }
  const std::string json = slurp(output / "run.json");
  EXPECT_NE(json.find("\"end\": \"failed\",\n  \"exit_code\": 4,\n"
                      "  \"error\": \"C:\\\\run: cannot \\\"write\\\"?it\",\n"),
            std::string::npos)
      << json;
  EXPECT_NE(json.find("\"frames\": 2,"), std::string::npos) << json;
  Simulation again(scene_);
  Recorder recorder(output, again, io::SequenceKind::kFrames, true, kProducer);
  recorder.begin();
  EXPECT_FALSE(std::filesystem::exists(output / "run.json"));
  EXPECT_EQ(again.clock().frame(), 2);
  run(again, recorder, 3);
  EXPECT_EQ(again.x(), simulation.x());
  EXPECT_EQ(io::open_sequence({output})->frame_count(), 4U);
}

TEST_F(RecorderTest, ARunThatIsKilledAtItsStartStillKnowsItsRepair) {
  for (const bool resume : {false, true}) {
    Simulation simulation(scene_);
    const StartRepair repair = resume ? StartRepair{} : StartRepair{3, 2, 0.5};
    Recorder recorder(folder_.path() / "out", simulation, io::SequenceKind::kFrames, resume, kProducer, repair);
    recorder.begin();
    EXPECT_EQ(recorder.resumed(), resume);
    EXPECT_EQ(recorder.totals().repair.pairs, 3);
    EXPECT_EQ(recorder.totals().repair.largest_move_m, 0.5);
  }
}

TEST_F(RecorderTest, WritesTheBitsThatWereSimulated) {
  Simulation simulation(scene_);
  std::vector<Positions> states = {simulation.x()};
  std::vector<double> times = {0};
  {
    Recorder recorder(folder_.path() / "steps", simulation, io::SequenceKind::kSteps, false, kProducer);
    recorder.begin();
    while (simulation.clock().frame() < kFrames) {
      recorder.record(simulation.step());
      states.push_back(simulation.x());
      times.push_back(simulation.clock().time_s());
    }
    recorder.finish({RunEnd::kComplete});
  }
  const auto sequence = io::open_sequence({folder_.path() / "steps"});
  ASSERT_EQ(sequence->frame_count(), states.size());
  EXPECT_EQ(sequence->kind(), io::SequenceKind::kSteps);
  ASSERT_EQ(sequence->groups().size(), 3u);
  EXPECT_EQ(sequence->groups()[1].role, io::Group::Role::kBody);
  for (std::size_t i = 0; i < states.size(); ++i) {
    EXPECT_EQ(sequence->time(i), times[i]);
    EXPECT_TRUE(same_bits(sequence->frame(i).points, states[i])) << "frame " << i;
  }
  EXPECT_EQ(sequence->frame(0).triangles, simulation.world().triangles);
}

TEST_F(RecorderTest, FramesAreTheStepsThatEndAFrame) {
  Simulation simulation(scene_);
  std::vector<Positions> states = {simulation.x()};
  {
    Recorder recorder(folder_.path() / "frames", simulation, io::SequenceKind::kFrames, false, kProducer);
    recorder.begin();
    while (simulation.clock().frame() < kFrames) {
      recorder.record(simulation.step());
      if (!simulation.clock().at_frame()) continue;
      states.push_back(simulation.x());
      // Whoever kills the run from here on loses nothing of this frame.
      EXPECT_EQ(read_checkpoint(folder_.path() / "frames" / "checkpoint.bin")->recorded, std::ssize(states));
    }
  }
  const auto sequence = io::open_sequence({folder_.path() / "frames"});
  ASSERT_EQ(sequence->frame_count(), std::size_t{kFrames} + 1);
  for (std::size_t i = 0; i < states.size(); ++i) EXPECT_TRUE(same_bits(sequence->frame(i).points, states[i]));
}

TEST_F(RecorderTest, WaitsOfBodiesThatAreNotThereAreDamage) {
  const auto folder = folder_.path() / "run", file = folder / "checkpoint.bin";
  {
    Simulation simulation(scene_);
    Recorder recorder(folder, simulation, io::SequenceKind::kFrames, false, kProducer);
    recorder.begin();
    run(simulation, recorder, 1);
  }
  const Checkpoint whole = read_checkpoint(file).value();
  const auto colliders = std::ssize(Simulation(scene_).world().colliders);
  ASSERT_GE(colliders, 1);
  const auto resume_with = [&](const BodyWaits& waits) {
    Checkpoint checkpoint = whole;
    checkpoint.waits = waits;
    write_checkpoint(file, checkpoint);
    Simulation simulation(scene_);
    const Recorder recorder(folder, simulation, io::SequenceKind::kFrames, true, kProducer);
    EXPECT_EQ(recorder.waits().size(), waits.size());
  };
  EXPECT_NO_THROW(resume_with({{colliders - 1, 1, 0, 1, 0}}));
  for (const BodyWaits& waits :
       {BodyWaits{{colliders, 1, 0, 1, 0}}, BodyWaits{{-1, 1, 0, 1, 0}}, BodyWaits{{0, 1, 0, 1, 0}, {0, 1, 0, 1, 0}}}) {
    EXPECT_THROW(resume_with(waits), io::Error);
  }
}

TEST_F(RecorderTest, AKilledRunResumesWithTheSameBits) {
  for (const io::SequenceKind kind : {io::SequenceKind::kSteps, io::SequenceKind::kFrames}) {
    const auto whole = folder_.path() / "whole", torn = folder_.path() / "torn";
    std::filesystem::remove_all(whole);
    std::filesystem::remove_all(torn);
    Simulation uninterrupted(scene_);
    Recorder complete(whole, uninterrupted, kind, false, kProducer);
    complete.begin();
    run(uninterrupted, complete, kFrames);
    // Killed twice: once before the first frame is whole, once later in the middle of a frame.
    for (const int steps : {1, 9, 1 << 20}) {
      Simulation simulation(scene_);
      Recorder recorder(torn, simulation, kind, true, kProducer);
      recorder.begin();
      run(simulation, recorder, kFrames, steps);
      if (steps < 1 << 20) continue;
      const auto a = io::open_sequence({whole}), b = io::open_sequence({torn});
      ASSERT_EQ(a->frame_count(), b->frame_count());
      for (std::size_t i = 0; i < a->frame_count(); ++i) {
        EXPECT_EQ(slurp(whole / a->frame_name(i)), slurp(torn / b->frame_name(i)));
        EXPECT_EQ(a->frame(i).points, b->frame(i).points) << "frame " << i;
        EXPECT_EQ(a->time(i), b->time(i));
      }
      EXPECT_EQ(recorder.totals().steps, complete.totals().steps);
      EXPECT_EQ(recorder.totals().repulsions, complete.totals().repulsions);
      EXPECT_EQ(recorder.totals().halvings, complete.totals().halvings);
      EXPECT_GT(recorder.totals().repulsions, 0) << "contacts on both sides of a kill";
    }
  }
}

TEST_F(RecorderTest, AnInterruptedRunResumesInTheMiddleOfAFrame) {
  const auto torn = folder_.path() / "torn";
  Simulation whole(scene_);
  while (whole.clock().frame() < kFrames) (void)whole.step();
  {
    Simulation simulation(scene_);
    Recorder recorder(torn, simulation, io::SequenceKind::kFrames, false, kProducer);
    recorder.begin();
    run(simulation, recorder, kFrames, 11);
    ASSERT_FALSE(simulation.clock().at_frame());
    recorder.finish({RunEnd::kInterrupted});
    EXPECT_NE(slurp(torn / "run.json").find("\"end\": \"interrupted\""), std::string::npos);
  }
  Simulation simulation(scene_);
  Recorder recorder(torn, simulation, io::SequenceKind::kFrames, true, kProducer);
  recorder.begin();
  EXPECT_TRUE(recorder.resumed());
  EXPECT_FALSE(simulation.clock().at_frame());
  run(simulation, recorder, kFrames);
  EXPECT_EQ(simulation.x(), whole.x());
}

TEST_F(RecorderTest, RefusesWhatIsNotItsOwn) {
  const auto output = folder_.path() / "out";
  {
    Simulation simulation(scene_);
    Recorder recorder(output, simulation, io::SequenceKind::kFrames, false, kProducer);
    recorder.begin();
    run(simulation, recorder, 2);
  }
  Simulation simulation(scene_);
  EXPECT_THROW(Recorder(output, simulation, io::SequenceKind::kFrames, false, kProducer), io::Error) << "not --resume";

  const Scene other =
      testing::write_and_read_scene(folder_.path() / "other.toml", small_scene_text(kFrames, "drag_1_s = 1\n"));
  Simulation other_simulation(other);
  EXPECT_THROW(Recorder(output, other_simulation, io::SequenceKind::kFrames, true, kProducer), io::Error);

  const auto file = output / "checkpoint.bin";
  const std::string good = slurp(file);
  for (const std::size_t position : {std::size_t{3}, std::size_t{40}, good.size() / 2, good.size() - 1}) {
    std::string bad = good;
    bad[position] = static_cast<char>(bad[position] ^ 1);
    std::ofstream(file, std::ios::binary) << bad;
    EXPECT_THROW((void)read_checkpoint(file), io::Error) << "byte " << position;
    std::ofstream(file, std::ios::binary) << good.substr(0, position);
    EXPECT_THROW((void)read_checkpoint(file), io::Error) << "cut at " << position;
  }
  std::ofstream(file, std::ios::binary) << good + "more";
  EXPECT_THROW((void)read_checkpoint(file), io::Error);
  std::ofstream(file, std::ios::binary) << good;
  EXPECT_TRUE(read_checkpoint(file).has_value());
  EXPECT_EQ(io::open_sequence({output})->frame_count(), 3u) << "nothing was lost by the refusals";
}

TEST_F(RecorderTest, ARefusedResumptionChangesNothing) {
  const auto output = folder_.path() / "out";
  {
    Simulation simulation(scene_);
    Recorder recorder(output, simulation, io::SequenceKind::kFrames, false, kProducer);
    recorder.begin();
    run(simulation, recorder, 2);
    recorder.finish({RunEnd::kInterrupted});
  }
  const auto list = output / "frames.jsonl";
  std::ofstream(list, std::ios::binary | std::ios::app) << "{\"torn";
  std::ofstream(output / "frames.jsonl.tmp-1") << "left by a kill";
  const auto contents = [&] {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(output)) {
      files[entry.path().filename().string()] = slurp(entry.path());
    }
    return files;
  };
  const auto before = contents();
  const auto refuse = [&](const std::string& more, const char* why) {
    const Scene scene = testing::write_and_read_scene(folder_.path() / "s.toml", small_scene_text(kFrames, more));
    Simulation simulation(scene);
    EXPECT_THROW(Recorder(output, simulation, io::SequenceKind::kFrames, true, kProducer), io::Error) << why;
  };
  refuse("drag_1_s = 1\n", "the checkpoint of another scene");
  EXPECT_EQ(contents(), before);
  std::filesystem::rename(output / "checkpoint.bin", folder_.path() / "checkpoint.bin");
  refuse("", "frames without a checkpoint");
  std::filesystem::rename(folder_.path() / "checkpoint.bin", output / "checkpoint.bin");
  EXPECT_EQ(contents(), before);
  const std::string text = slurp(list);
  std::ofstream(list, std::ios::binary) << text.substr(0, text.find('\n') + 1);
  const auto shorter = contents();
  refuse("", "fewer frames than the checkpoint needs");
  EXPECT_EQ(contents(), shorter);
}

TEST_F(RecorderTest, RunJsonIsGoneWhileARunGoesOn) {
  const auto output = folder_.path() / "out";
  for (const bool resume : {false, true}) {
    Simulation simulation(scene_);
    Recorder recorder(output, simulation, io::SequenceKind::kFrames, resume, kProducer);
    recorder.begin();
    EXPECT_FALSE(std::filesystem::exists(output / "run.json")) << "a kill would leave the end of the run before";
    run(simulation, recorder, resume ? 2 : 1);
    recorder.finish({RunEnd::kComplete});
    EXPECT_TRUE(std::filesystem::exists(output / "run.json"));
  }
}

TEST_F(RecorderTest, NoFileIsEverHalfWritten) {
  // Another name of a file keeps what was in it if the file is replaced, and shows what is written into it if not.
  const auto output = folder_.path() / "out", kept = folder_.path() / "kept";
  Simulation simulation(scene_);
  Recorder recorder(output, simulation, io::SequenceKind::kFrames, false, kProducer);
  recorder.begin();
  recorder.finish({RunEnd::kInterrupted});
  std::filesystem::create_directory(kept);
  const auto files = {"checkpoint.bin", "run.json"};
  for (const char* file : files) std::filesystem::create_hard_link(output / file, kept / file);
  std::vector<std::string> before;
  for (const char* file : files) before.push_back(slurp(output / file));
  run(simulation, recorder, 2);
  recorder.finish({RunEnd::kComplete});
  for (std::size_t i = 0; const char* file : files) {
    EXPECT_NE(slurp(output / file), before[i]) << file;
    EXPECT_EQ(slurp(kept / file), before[i++]) << file;
  }
}

TEST_F(RecorderTest, RunJsonHasTheTotals) {
  Simulation simulation(scene_);
  Recorder recorder(folder_.path() / "out", simulation, io::SequenceKind::kFrames, false, kProducer);
  recorder.begin();
  run(simulation, recorder, 2);
  recorder.finish({RunEnd::kComplete});
  const std::string json = slurp(folder_.path() / "out" / "run.json");
  for (const std::string& part :
       {std::string("\"schema\": \"selvage.run/1\""), std::string("\"frames\": 2,"),
        std::string("\"end\": \"complete\""), "\"steps\": " + std::to_string(recorder.totals().steps) + ",",
        std::string("\"exit_code\": 0,"), std::string("\"error\": null,")}) {
    EXPECT_NE(json.find(part), std::string::npos) << part;
  }
}

TEST_F(RecorderTest, RunJsonIsJsonWhateverTheNumbersAre) {
  Simulation simulation(scene_);
  Recorder recorder(folder_.path() / "out", simulation, io::SequenceKind::kFrames, false, kProducer);
  recorder.begin();
  StepResult step = simulation.step();
  step.most_strained.strain = std::numeric_limits<double>::infinity();
  recorder.record(step);
  recorder.finish({RunEnd::kComplete});
  const std::string json = slurp(folder_.path() / "out" / "run.json");
  EXPECT_NE(json.find("\"largest_strain\": null,"), std::string::npos) << json;
}

TEST_F(RecorderTest, PhasesOfARunAreTimed) {
  Simulation simulation(scene_);
  Recorder recorder(folder_.path() / "out", simulation, io::SequenceKind::kFrames, false, kProducer);
  recorder.begin();
  const auto start = std::chrono::steady_clock::now();
  run(simulation, recorder, 2);
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  recorder.finish({RunEnd::kComplete});
  const StepPhases& phases = recorder.totals().phases;
  const CollisionPhases& within = phases.within;
  EXPECT_GT(phases.dynamics.wall_s, 0);
  EXPECT_GT(within.proximity.wall_s, 0);
  EXPECT_GT(within.search.wall_s, 0);
  const double parts_s =
      within.proximity.wall_s + within.repulsion.wall_s + within.search.wall_s + within.response.wall_s;
  EXPECT_LE(parts_s, phases.collision.wall_s);
  EXPECT_LE(recorder.totals().all().wall_s, elapsed_s);
  EXPECT_GE(recorder.totals().all().wall_s, elapsed_s / 2) << "a phase is missing";
  const std::string json = slurp(folder_.path() / "out" / "run.json");
  for (const char* name :
       {"dynamics", "proximity", "repulsion", "search", "response", "collision", "velocity", "recording"}) {
    EXPECT_NE(json.find(std::string("\"") + name + "_s\": "), std::string::npos) << name;
    EXPECT_NE(json.find(std::string("\"") + name + "_cpu_s\": "), std::string::npos) << name;
  }
}

}  // namespace selvage
