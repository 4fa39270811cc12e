#include <gtest/gtest.h>

#include "io/sequence.h"
#include "tests/cli/run_program.h"
#include "tests/cli/two_roles.h"

namespace selvage {
namespace {

namespace fs = std::filesystem;
using testing::expect_text;
using testing::run_program;
using testing::spit;
using testing::TemporaryFolder;

/// A large face, and a small one at a distance of `gap` above it, both `lift` above the ground.
io::Points face_pair_points(double gap, double lift) {
  const double z = lift + gap;
  return {{0, 0, lift}, {4, 0, lift}, {0, 4, lift}, {1, 1, z}, {2, 1, z}, {1, 2, z}};
}
const io::Triangles kFaces = {{0, 1, 2}, {3, 4, 5}};

/// A sequence folder of frames 40 ms apart.
void record(const fs::path& folder, const std::vector<io::Points>& frames,
            io::SequenceKind kind = io::SequenceKind::kFrames, const std::vector<io::Group>& groups = {}) {
  io::SequenceWriter writer(folder, {kFaces, groups, kind, io::Precision::kFloat64, "test"});
  for (std::size_t i = 0; i < frames.size(); ++i) writer.append(0.04 * static_cast<double>(i), frames[i]);
}

const std::vector<io::Points> kApart = {face_pair_points(1, 0), face_pair_points(0.1, 0), face_pair_points(0.3, 1)};

}  // namespace

// "Remove it" would be advice to lose what is converted.
TEST(ConvertCommand, WhatIsReadIsNotSaidToBeInTheWay) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", cache = folder.path() / "a.pc2";
  spit(mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto onto_base = run_program(folder, {"convert", mesh, "-o", cache});
  EXPECT_EQ(onto_base.exit_code, 4);
  expect_text(onto_base.err,
              mesh.string() + " is read, and the base mesh of " + cache.string() + " would take its place");
  const auto onto_itself = run_program(folder, {"convert", mesh, "-o", mesh});
  EXPECT_EQ(onto_itself.exit_code, 4);
  expect_text(onto_itself.err, mesh.string() + " is read, and the result would take its place");
  EXPECT_FALSE(fs::exists(cache));
}

TEST(ConvertCommand, EveryFormatKeepsTheVerdictAndSaysWhatItDoesNotKeep) {
  const TemporaryFolder folder;
  record(folder.path() / "run", kApart, io::SequenceKind::kSteps);
  const struct {
    const char *output, *lost;
  } cases[] = {{"copy/", ""},
               {"a.npz", "not kept:  times, that frames are steps\n"},
               {"a.pc2", "not kept:  times, that frames are steps\n"},
               {"b.obj", "not kept:  times, that frames are steps\n"}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.output);
    const auto result =
        run_program(folder, {"convert", folder.path() / "run", "-o", folder.path() / c.output, "--recheck"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    expect_text(result.out, "written:   " + folder.path().string());
    expect_text(result.out, "3 frames as ");
    expect_text(result.out, "as written: clean\n");
    expect_text(result.out, "3 of 3 checked, 0 violated");
    expect_text(result.out, "2 of 2 checked, 0 violated");  // motions, though most formats cannot claim steps
    EXPECT_EQ(result.out.find("not kept") == std::string::npos, c.lost == std::string()) << result.out;
    expect_text(result.out, c.lost);
  }
  EXPECT_EQ(io::open_sequence({folder.path() / "copy"})->time(2), 0.08);
  EXPECT_EQ(run_program(folder, {"verify", folder.path() / "a.pc2"}).exit_code, 0);
  const auto motion =
      run_program(folder, {"convert", folder.path() / "a.pc2", "-o", folder.path() / "c.npz", "--recheck", "--motion"});
  EXPECT_EQ(motion.exit_code, 0) << motion.err;
  expect_text(motion.out, "2 of 2 checked, 0 violated");  // asked for, though a PC2 claims no steps
  const auto pvd = run_program(folder, {"convert", folder.path() / "run", "-o", folder.path() / "a.pvd"});
  EXPECT_EQ(pvd.exit_code, 0) << pvd.err;
  EXPECT_TRUE(fs::exists(folder.path() / "a_000002.vtp"));
}

TEST(ConvertCommand, RoundingThatMakesAnIntersectionIsFound) {
  const TemporaryFolder folder;
  record(folder.path() / "run",
         {face_pair_points(1e-6, 10), face_pair_points(1e-6, 100)});  // a float at 100 is 7.6e-6 wide
  EXPECT_EQ(run_program(folder, {"verify", folder.path() / "run"}).exit_code, 0);
  const auto result =
      run_program(folder, {"convert", folder.path() / "run", "-o", folder.path() / "a.pc2", "--recheck"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  expect_text(result.out,
              "float64 to float32, rounded to nearest: 6 of 36 values changed, the largest by 9.9999999747524271e-07");
  expect_text(result.out, "as written: violated\n");
  expect_text(result.out, "a.pc2[1]");
  const auto exact =
      run_program(folder, {"convert", folder.path() / "run", "-o", folder.path() / "a.npz", "--recheck"});
  EXPECT_EQ(exact.exit_code, 0) << exact.out;
  expect_text(exact.out, "precision: float64, every value kept\n");
}

TEST(ConvertCommand, RecheckFindsWhatMotionRoundingMakes) {
  const TemporaryFolder folder;
  // The corner of one face passes the edge of the other by two hairs, between the frames. Rounded, it touches.
  const double hair = 0x1p-30;
  const auto at_height = [&](double z) -> io::Points {
    return {{16 + hair, 0, 8}, {20, 0, 8}, {16 + hair, 4, 8}, {7, 1, z}, {16 - hair, 1, z}, {7, 2, z}};
  };
  const io::Points before = at_height(9), after = at_height(7);
  record(folder.path() / "run", {before, after}, io::SequenceKind::kSteps);
  EXPECT_EQ(run_program(folder, {"verify", folder.path() / "run"}).exit_code, 0);
  const auto result =
      run_program(folder, {"convert", folder.path() / "run", "-o", folder.path() / "a.pc2", "--recheck"});
  EXPECT_EQ(result.exit_code, 1) << result.out;
  expect_text(result.out, "2 of 2 checked, 0 violated");
  expect_text(result.out, "1 of 1 checked, 1 violated");
}

TEST(ConvertCommand, WhatRoundingPutsAtOnePlaceIsNotTakenForASeam) {
  const TemporaryFolder folder;
  const double above = 1 + 0x1p-30;
  record(folder.path() / "run", {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {0, 0, above}, {4, 0, above}, {0, 4, above}}});
  const auto result =
      run_program(folder, {"convert", folder.path() / "run", "-o", folder.path() / "a.pc2", "--recheck"});
  EXPECT_EQ(result.exit_code, 1) << result.out;
  expect_text(result.out, "6 vertices of the violations lie at the place of another, where rounding or a seam");
  EXPECT_EQ(result.out.find("--weld"), std::string::npos) << result.out;
}

TEST(ConvertCommand, BodiesStayBodiesInTheRecheck) {
  const TemporaryFolder folder;
  const std::vector<io::Group> bodies = {{"floor", io::Group::Role::kBody, 0, 1},
                                         {"box", io::Group::Role::kBody, 1, 2}};
  std::vector<io::Group> one_cloth = bodies;
  one_cloth[1].role = io::Group::Role::kCloth;
  record(folder.path() / "bodies", {face_pair_points(0, 0)}, io::SequenceKind::kFrames, bodies);
  record(folder.path() / "cloth", {face_pair_points(0, 0)}, io::SequenceKind::kFrames, one_cloth);
  const auto unknown =
      run_program(folder, {"convert", folder.path() / "bodies", "-o", folder.path() / "bodies.obj", "--recheck"});
  EXPECT_EQ(unknown.exit_code, 5) << unknown.out;  // nothing but bodies, which are not checked: as verify says it
  EXPECT_EQ(run_program(folder, {"verify", folder.path() / "bodies"}).exit_code, 5);
  expect_text(unknown.out,
              "not kept:  which faces are bodies\nbodies:    \"box\", \"floor\"; selvage verify takes them "
              "for cloth without --body box --body floor\n");
  const auto touching =
      run_program(folder, {"convert", folder.path() / "cloth", "-o", folder.path() / "cloth.obj", "--recheck"});
  EXPECT_EQ(touching.exit_code, 1) << touching.out;
}

TEST(ConvertCommand, WhatItSaysOfBodiesMakesVerifyKnowThem) {
  const TemporaryFolder folder;
  // Two bodies that overlap, one with a name for which a shell wants quotes, beside cloth.
  io::Points points = face_pair_points(0, 0);
  for (const auto& point : face_pair_points(0, 9)) points.push_back(point);
  const io::Triangles faces = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  const std::vector<io::Group> groups = {{"floor", io::Group::Role::kBody, 0, 1},
                                         {"a \"box", io::Group::Role::kBody, 1, 2},
                                         {"sheet", io::Group::Role::kCloth, 2, 3}};
  io::SequenceWriter(folder.path() / "run", {faces, groups, io::SequenceKind::kFrames, io::Precision::kFloat64, "test"})
      .append(0, points);
  EXPECT_EQ(run_program(folder, {"verify", folder.path() / "run"}).exit_code, 0);
  const auto cache = folder.path() / "a.pc2";
  const auto converted = run_program(folder, {"convert", folder.path() / "run", "-o", cache});
  expect_text(converted.out,
              "bodies:    \"a \"box\", \"floor\"; selvage verify takes them for cloth without --body 'a \"box' --body "
              "floor\n");
  EXPECT_EQ(run_program(folder, {"verify", cache}).exit_code, 1) << "as cloth they overlap";
  const auto told = run_program(folder, {"verify", cache, "--body", "a \"box", "--body", "floor"});
  EXPECT_EQ(told.exit_code, 0) << told.out << told.err;
  for (const char* output : {"a.npz", "copy/", "a.pvd"}) {
    const auto kept = run_program(folder, {"convert", folder.path() / "run", "-o", folder.path() / output});
    EXPECT_EQ(kept.out.find("bodies:"), std::string::npos) << kept.out;
  }
  // A name that the cloth has too would make bodies of both.
  std::vector<io::Group> shared = groups;
  shared[2].name = "floor";
  io::SequenceWriter(folder.path() / "shared",
                     {faces, shared, io::SequenceKind::kFrames, io::Precision::kFloat64, "test"})
      .append(0, points);
  expect_text(run_program(folder, {"convert", folder.path() / "shared", "-o", folder.path() / "b.pc2"}).out,
              "without --body 'a \"box'; \"floor\" is the name of cloth too: rename one before\n");
}

TEST(ConvertCommand, RangeOfFrames) {
  const TemporaryFolder folder;
  record(folder.path() / "run", kApart);
  const auto convert = [&](const std::string& range, const std::string& output) {
    return run_program(folder, {"convert", folder.path() / "run", "-o", folder.path() / output, "--frames", range});
  };
  EXPECT_EQ(convert("1:3", "a.npz").exit_code, 0);
  const auto two = io::open_sequence({folder.path() / "a.npz"});
  ASSERT_EQ(two->frame_count(), 2u);
  EXPECT_EQ(two->frame(0).points, kApart[1]);
  EXPECT_EQ(two->frame(1).points, kApart[2]);
  EXPECT_EQ(convert(":1", "b.obj").exit_code, 0);
  EXPECT_EQ(io::open_sequence({folder.path() / "b.obj"})->frame(0).points, kApart[0]);
  EXPECT_EQ(convert("2:", "c").exit_code, 0);
  EXPECT_EQ(io::open_sequence({folder.path() / "c"})->frame(0).points, kApart[2]);
  for (const char* range : {"1:1", "2:1", "0:4", "3:", "1", "a:b", "-1:2", "1:2:3", "1.0:2", "99999999999999999999:"}) {
    const auto refused = convert(range, "never.npz");
    EXPECT_EQ(refused.exit_code, 2) << range << refused.out << refused.err;
    EXPECT_FALSE(fs::exists(folder.path() / "never.npz"));
  }
}

TEST(ConvertCommand, MistakesHaveTheirExitCodes) {
  const TemporaryFolder folder;
  const std::string run = folder.path() / "run", npz = folder.path() / "a.npz", two = folder.path() / "two.obj";
  record(run, kApart);
  record(folder.path() / "foreign", kApart);
  const std::string two_roles = folder.path() / "two_roles";
  record(two_roles, kApart);
  testing::give_two_roles(two_roles);
  spit(npz, "mine");
  spit(two, "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  spit(folder.path() / "three.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 1\nf 1 2 4\n");
  const struct {
    int exit_code;
    std::vector<std::string> arguments;
    const char* message;
  } cases[] = {
      {2, {run}, "output"},
      {2, {run, "-o", folder.path() / "a.ply"}, "extension"},
      {2, {run, "-o", folder.path() / ".npz"}, "no name before the extension"},
      {3, {two_roles, "-o", folder.path() / "b.npz"}, "two_roles/frame_000000.npy: face 1 is in the group"},
      {2, {run, "-o", folder.path() / "a.pvd", "--recheck"}, "VTP is not read"},
      {2, {run, "-o", folder.path() / "b.npz", "--motion"}, "recheck"},
      {2, {run, "-o", folder.path() / "b.npz", "--recheck", "--motion", "--frames", ":1"}, "at least two frames"},
      {3, {two, folder.path() / "three.obj", "-o", folder.path() / "b.npz"}, "change between frames"},
      {4, {folder.path() / "none", "-o", folder.path() / "b.npz"}, "none"},
      {4, {run, "-o", npz}, "is there already"},
      {4, {run, "-o", folder.path() / "foreign"}, "not empty"},
      {4, {run, "-o", folder.path() / "no" / "b.npz"}, "No such file"},
  };
  for (const auto& c : cases) {
    std::vector<std::string> arguments = {"convert"};
    arguments.insert(arguments.end(), c.arguments.begin(), c.arguments.end());
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, c.exit_code) << c.message << result.out << result.err;
    EXPECT_EQ(result.out, "");
    expect_text(result.err, c.message);
  }
  EXPECT_EQ(testing::slurp(npz), "mine");
  EXPECT_FALSE(fs::exists(folder.path() / "b.npz"));
  EXPECT_EQ(io::open_sequence({folder.path() / "foreign"})->frame_count(), 3u);
}

TEST(ConvertCommand, AFrameWithoutFacesIsRefused) {
  const TemporaryFolder folder;
  const std::string none = folder.path() / "none.ply";
  spit(none,
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 0\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n");
  spit(folder.path() / "one.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  for (const char* output : {"a.obj", "a.npz", "a.pc2", "a.pvd", "a"}) {
    SCOPED_TRACE(output);
    const auto result = run_program(folder, {"convert", none, "-o", folder.path() / output});
    EXPECT_EQ(result.exit_code, 3) << result.out;
    expect_text(result.err, "none.ply: no faces: there is nothing to convert");
    EXPECT_FALSE(fs::exists(folder.path() / output));
  }
  const auto later = run_program(folder, {"convert", folder.path() / "one.obj", none, "-o", folder.path() / "a.obj"});
  EXPECT_EQ(later.exit_code, 3) << later.out;
  EXPECT_FALSE(fs::exists(folder.path() / "a_000000.obj"));
}

TEST(ConvertCommand, HelpStartsWithAnExample) {
  const auto result = run_program({"convert", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.out.starts_with("Example: selvage convert ")) << result.out;
}

}  // namespace selvage
