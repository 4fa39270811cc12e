// Failures of steps, meshes, scenes and files as case files: nothing is lost, what is hostile is refused by name, and
// shrinking leaves a handful of vertices, of lines, of choices.
#include "fuzz/kept/kept_case.h"

#include <bit>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "fuzz/kept/broad_case.h"
#include "fuzz/kept/collisions_case.h"
#include "fuzz/kept/file_case.h"
#include "fuzz/kept/scene_case.h"
#include "fuzz/kept/step_case.h"
#include "fuzz/kept/subdivision_case.h"
#include "fuzz/run/redraw.h"
#include "fuzz/shrink/shrink_bytes.h"
#include "fuzz/shrink/shrink_choices.h"
#include "fuzz/shrink/shrink_mesh.h"
#include "tests/fuzz/nothing_done.h"
#include "tests/fuzz/spoilt_text.h"

namespace selvage::fuzz {
namespace {

const char* const kStep =
    "selvage-case 1 step\nseed step:soup:1:7\nfailure touches  # a comment\n"
    "set thickness_m 0x1p-3\nset tolerance_m 0\nset repulsion 1\nset repulsion_stiffness_n_m 0\n"
    "set overlap_fraction 0.125\nset relaxation 1\nset friction_kinetic 0.5\nset friction_static 0.5\n"
    "set impulse_iterations 3\nset zone_iterations 0\nset max_intervals 64\nset float32 0\nset yield 1\nset dt_s "
    "0x1p-5\n"
    "vertices 4\nv 0 0 0  0 0 nan  1 -1\nv 1 0 0  1 0 0  1 -1\nv 0 1 0  0 1 0  1 -1\nv 0 0 1  0 0 -1  0 2\n"
    "faces 1\nf 0 1 2\n";

/// The step of the case number `seed` that `step` fails, or nothing.
std::optional<MeshCase> failing_step(std::uint64_t seed, const StepFunction& step, StepDefect defect) {
  ChoiceSource source = ChoiceSource::from_seed(seed);
  const StepWorld world = make_step_world(source);
  const StepObservation seen = run_steps(source, world, step);
  if (seen.defect != defect) return std::nullopt;
  return step_case(world, seen.x_t0, seen.x_candidate);
}

void expect_same_bits(const Positions& a, const Positions& b) {
  ASSERT_EQ(a.size(), b.size());
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.reshaped()[i]), std::bit_cast<std::uint64_t>(b.reshaped()[i]));
  }
}

MeshCase parsed_again(const MeshCase& kept) {
  const ParsedCase parsed = parse_kept_case(kept_text(KeptMesh(kept), "a:b:1:2", "touches"), "again", redraw);
  EXPECT_EQ(parsed.origin, "a:b:1:2");
  EXPECT_EQ(parsed.failure, "touches");
  return dynamic_cast<const KeptMesh&>(*parsed.kept).mesh();
}

TEST(KeptCase, KeepsEveryBitOfAMesh) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    ChoiceSource source = ChoiceSource::from_seed(seed);
    const StepWorld world = make_step_world(source);
    std::string_view candidate_class;
    const Positions candidate = choose_candidate(source, world, world.x, candidate_class);
    const MeshCase step = step_case(world, world.x, candidate);
    const MeshCase broad = broad_case(world.mesh, {world.x, candidate, world.x}, {BroadQuestion{0.1, {}}, {}});
    const MeshCase subdivision =
        subdivision_case(world.mesh.faces, world.x, std::vector<double>(world.inverse_mass.size(), 0), 2);
    const MeshCase collisions = collisions_case(world.mesh, world.x, candidate, 0.1, {});
    for (const MeshCase& kept : {step, broad, collisions, subdivision}) {
      const MeshCase again = parsed_again(kept);
      EXPECT_EQ(again.kind, kept.kind);
      EXPECT_EQ(again.settings, kept.settings);
      EXPECT_EQ(again.marks, kept.marks);
      EXPECT_EQ(again.faces, kept.faces);
      for (std::size_t i = 0; i < kept.x.size(); ++i) expect_same_bits(again.x[i], kept.x[i]);
      if (kept.kind == &subdivision_kind()) continue;  // costly, and the surfaces of bodies may intersect each other
      EXPECT_EQ(retry(kept).unfit, "") << "what a campaign makes is promised something";
    }
  }
}

TEST(KeptCase, KeepsEveryByteOfAFile) {
  std::string bytes;
  for (int i = 0; i < 1024; ++i) bytes += static_cast<char>(i * i / 7);
  bytes += "a line with # and \\ and blanks at its end  \n  \n\n";
  const ParsedCase parsed =
      parse_kept_case(kept_text(KeptBytes(file_case("ply", bytes)), "files:ply:1:2", "unsound"), "again", redraw);
  EXPECT_EQ(dynamic_cast<const KeptBytes&>(*parsed.kept).bytes().bytes, bytes);
  EXPECT_EQ(dynamic_cast<const KeptBytes&>(*parsed.kept).bytes().value, "ply");
}

void expect_bad_kept_case(const std::string& text, const std::string& words) {
  testing::expect_bad_input([&] { (void)parse_kept_case(text, "x.case", redraw); }, text, words);
}

TEST(KeptCase, NamesLineAndFieldOfWhatIsWrong) {
  ASSERT_NO_THROW((void)parse_kept_case(kStep, "x.case", redraw));
  const std::string step = kStep;
  expect_bad_kept_case(testing::replaced(step, "1 step", "1 stop"), "x.case:1: there is no kind of case 'stop'");
  expect_bad_kept_case(testing::replaced(step, "seed", "sed"), "x.case:2: expected 'seed'");
  expect_bad_kept_case(testing::replaced(step, "set thickness_m 0x1p-3\n", ""), "x.case:4: expected 'thickness_m'");
  expect_bad_kept_case(testing::replaced(step, "thickness_m 0x1p-3", "thickness_m -1"),
                       "x.case:4: thickness_m: -1 is not from");
  expect_bad_kept_case(testing::replaced(step, "repulsion 1", "repulsion 2"),
                       "x.case:6: repulsion: '2' is not an integer from 0 to 1");
  expect_bad_kept_case(testing::replaced(step, "relaxation 1", "relaxation nan"),
                       "x.case:9: 'nan' is not a finite number");
  expect_bad_kept_case(testing::replaced(step, "vertices 4", "vertices 99999999999"),
                       "x.case:18: vertices: '99999999999' is not");
  expect_bad_kept_case(testing::replaced(step, "vertices 4", "vertices 5"), "x.case:23: expected 'v'");
  expect_bad_kept_case(testing::replaced(step, "v 0 0 0 ", "v 0 0 inf "), "x.case:19: 'inf' is not a finite number");
  expect_bad_kept_case(testing::replaced(step, "  0 2\n", "  0\n"), "x.case:22: a word is missing");
  expect_bad_kept_case(testing::replaced(step, "  0 2\n", "  0 -2\n"),
                       "x.case:22: body: '-2' is not an integer from -1");
  expect_bad_kept_case(testing::replaced(step, "f 0 1 2", "f 0 1 4"),
                       "x.case:24: vertex of a face: '4' is not an integer from 0 to 3");
  expect_bad_kept_case(testing::replaced(step, "f 0 1 2", "f 0 1 1"), "x.case:24: a face names a vertex twice");
  expect_bad_kept_case(testing::replaced(step, "f 0 1 2\n", ""), "x.case:23: the case ends too early");
  expect_bad_kept_case(step + "f 0 1 3\n", "x.case:25: nothing may follow the faces");
  expect_bad_kept_case("selvage-case 1 subdivision\nseed a\nfailure b\nset levels 9\n",
                       "x.case:4: levels: '9' is not an integer");
  const std::string file = "selvage-case 1 file\nseed a\nfailure b\n";
  expect_bad_kept_case(file + "format elf\n", "x.case:4: format: 'elf' is not known");
  expect_bad_kept_case(file + "format obj\n| a\\qb\n", "x.case:5: '\\' is followed by");
  expect_bad_kept_case(file + "format obj\n| a\\x4\n", "x.case:5: '\\' is followed by");
  expect_bad_kept_case(file + "format obj\na\n", "x.case:5: expected '|'");
  expect_bad_kept_case("selvage-case 1 simulation\nseed a\nfailure b\nsteps 0\n", "x.case:4: steps: '0' is not known");
  expect_bad_kept_case("selvage-case 1 drawn\nseed step:sup:1:2\nfailure hung\n",
                       "x.case:3: seed: 'step:sup:1:2' is not");
}

TEST(KeptCase, WhatPromisesNothingIsNotRun) {
  const auto unfit = [](const std::string& text) {
    return parse_kept_case(text, "x.case", redraw).kept->retry().unfit;
  };
  const std::string step = testing::replaced(testing::replaced(kStep, "0 0 nan", "0 0 0"), "f 0 1 2", "f 0 1 3");
  EXPECT_EQ(unfit(step), "");
  EXPECT_EQ(unfit(testing::replaced(step, "  0 2\n", "  1 2\n")), "a vertex of a body has a mass");
  EXPECT_EQ(unfit(testing::replaced(step, "kinetic 0.5", "kinetic 0.75")), "friction_kinetic is above friction_static");
  EXPECT_EQ(unfit(testing::replaced(step, "v 0 0 1 ", "v 2 0 0 ")), "the surface intersects itself at the start");
  EXPECT_EQ(unfit(testing::replaced(testing::replaced(step, "float32 0", "float32 1"), "v 0 0 1 ", "v 0 0 0.1 ")),
            "a vertex does not start on the float32 lattice");
  EXPECT_NE(unfit("selvage-case 1 simulation\nseed a\nfailure b\nsteps 2\n| [time\\n\n").find("the case:1"),
            std::string::npos);
}

TEST(ShrinkMesh, AStepThatDoesNothingIsShownByAHandfulOfVertices) {
  static const MeshKind planted = [] {
    MeshKind kind = step_kind();
    kind.retry = [](const MeshCase& kept) { return retry_step(kept, nothing_done); };
    return kind;
  }();
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);  // as a worker
  int failures = 0;
  for (std::uint64_t seed = 0; seed < 30 && failures < 3; ++seed) {
    std::optional<MeshCase> kept = failing_step(seed, nothing_done, StepDefect::kTouches);
    if (!kept) continue;
    ++failures;
    kept->kind = &planted;
    const MeshCase small = shrink(*kept, "touches");
    EXPECT_EQ(retry(small).failure, "touches");
    EXPECT_LE(small.vertex_count(), 6U) << seed;
    EXPECT_LE(small.faces.size(), 2U) << seed;
    EXPECT_LE(cost_of(small).non_zero, 16) << seed;
    EXPECT_EQ(cost_of(small).numbers, 0) << seed;
    const Retrial ours = retry(parsed_again(small));  // the step that is not planted
    EXPECT_EQ(ours.failure, "") << seed;
    EXPECT_EQ(ours.unfit, "") << seed;
  }
  EXPECT_EQ(failures, 3);
}

TEST(ShrinkBytes, LeavesWhatMatters) {
  static const ByteKind planted{"file", "", "format", nullptr, [](const ByteCase& kept) {
                                  const bool bad = kept.bytes.find("\nf 7") != kept.bytes.npos;
                                  return Retrial{bad ? "unsound" : "", {}, {}};
                                }};
  const ByteCase kept{&planted, "obj", "v 0 0 0\nv 1.2345 0 0\n\nf 789 1 2\ng a\n"};
  EXPECT_EQ(shrink(kept, "unsound", 5000).bytes, "\nf 7");
}

TEST(ShrinkBytes, KeepsTheFailureAndWhatItIsPromisedFor) {
  static int trials = 0;
  // Without a 'v' it fails in another way; without the end of a line nothing is promised.
  static const ByteKind planted{
      "file", "", "format", nullptr, [](const ByteCase& kept) {
        ++trials;
        const auto has = [&](const char* part) { return kept.bytes.find(part) != kept.bytes.npos; };
        return Retrial{!has("f 7") ? "" : has("v") ? "unsound" : "crashed", {}, has("\n") ? "" : "no line"};
      }};
  const ByteCase kept{&planted, "obj", "v 0 0 0\nv 1.2345 0 0\nf 789 1 2\ng a\n"};
  const Retrial small = retry(shrink(kept, "unsound", 5000));
  EXPECT_EQ(small.failure, "unsound");
  EXPECT_EQ(small.unfit, "");
  EXPECT_EQ(shrink(kept, "unsound", 5000).bytes.size(), 5U);
  for (const int most : {0, 1, 20}) {
    trials = 0;
    (void)shrink(kept, "unsound", most);
    EXPECT_EQ(trials, most);
  }
}

TEST(ShrinkChoices, LeavesFewAndSmallAnswers) {
  // Fails where two answers in a row are at least 100 and 7.
  const auto failure_of = [](ChoiceSource source) -> std::string {
    std::uint32_t last = 0;
    for (int i = 0; i < 50; ++i) {
      const std::uint32_t answer = source.n(1000);
      if (last >= 100 && answer >= 7) return "pair";
      last = answer;
    }
    return "";
  };
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Choices choices = shrink_choices(ChoiceSource::from_seed(seed), "pair", failure_of, 2000);
    EXPECT_EQ(choices, (Choices{100, 7})) << seed;
  }
  EXPECT_EQ(shrink_choices(ChoiceSource::from_seed(1), "other", failure_of, 2000).size() > 1, true) << "as they were";
}

}  // namespace
}  // namespace selvage::fuzz
