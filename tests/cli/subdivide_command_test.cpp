#include <cmath>
#include <csignal>

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

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// Two tents of four faces, the second one `gap` above the first; below 0 they intersect.
void record(const std::filesystem::path& folder, double gap) {
  io::Points points;
  io::Triangles triangles;
  for (const double z : {0.0, gap}) {
    const auto base = static_cast<std::int32_t>(points.size());
    points.insert(points.end(), {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}, {0, 0, 0.5 + z}});
    for (std::int32_t k = 0; k < 4; ++k) triangles.push_back({base + k, base + (k + 1) % 4, base + 4});
  }
  io::SequenceWriter writer(folder, {triangles, {}, io::SequenceKind::kFrames, io::Precision::kFloat64, "test"});
  writer.append(0, points);
  for (auto& p : points) p[0] += 1;
  writer.append(0.5, points);
}

}  // namespace

TEST(SubdivideCommand, WritesFinerFramesThatVerifyFindsClean) {
  const TemporaryFolder folder;
  record(folder.path() / "run", 0.01);
  const auto result =
      run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "fine", "--levels", "2"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("2 frames, 8 faces to 128"), std::string::npos) << result.out;
  const auto fine = io::open_sequence({folder.path() / "fine"});
  ASSERT_EQ(fine->frame_count(), 2U);
  EXPECT_EQ(fine->frame(1).triangles.size(), 128U);
  EXPECT_EQ(fine->time(1), 0.5);
  EXPECT_EQ(run_program(folder, {"verify", folder.path() / "fine"}).exit_code, 0);

  const auto one = run_program(
      folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "one", "--frame", "1", "--threads", "1"});
  EXPECT_EQ(one.exit_code, 0) << one.err;
  const auto alone = io::open_sequence({folder.path() / "one"});
  EXPECT_EQ(alone->frame_count(), 1U);
  EXPECT_EQ(alone->time(0), 0.5) << "that of the frame it was made of";
  EXPECT_EQ(
      run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "two", "--frame", "2"}).exit_code,
      2);
}

TEST(SubdivideCommand, RefusesFramesThatIntersect) {
  const TemporaryFolder folder;
  record(folder.path() / "run", 0);
  const auto result = run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "fine"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find(" already, the first of faces "), std::string::npos) << result.err;
  expect_text(result.err, "subdivide the others one by one with --frame");
  EXPECT_FALSE(fs::exists(folder.path() / "fine"));
  const auto alone =
      run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "fine", "--frame", "1"});
  EXPECT_EQ(alone.exit_code, 1);
  EXPECT_EQ(alone.err.find("the others"), std::string::npos) << alone.err;
}

TEST(SubdivideCommand, AFaceHasOneRole) {
  const TemporaryFolder folder;
  record(folder.path() / "run", 0.01);
  testing::give_two_roles(folder.path() / "run");
  const auto result = run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "fine"});
  EXPECT_EQ(result.exit_code, 3) << result.out;
  expect_text(result.err, "frame_000000.npy: face 1 is in the group \"coat\", which is cloth, and in \"arm\"");
  EXPECT_FALSE(fs::exists(folder.path() / "fine"));
}

TEST(SubdivideCommand, BodiesOfAFormatWithoutRolesCanBeNamed) {
  const TemporaryFolder folder;
  spit(folder.path() / "a.obj",
       "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 2\ng coat\nf 1 2 3\ng ball\nf 4 5 6\nf 5 7 6\n");
  const auto fine = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"subdivide", folder.path() / "a.obj", "-o", folder.path() / name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  };
  expect_text(fine("cloth", {}), "all groups are taken for cloth: \"coat\", \"ball\"; --body NAME says which is none");
  const std::string with_body = fine("body", {"--body", "ball"});
  expect_text(with_body, "bodies not against each other or themselves");
  EXPECT_EQ(with_body.find("taken for cloth"), std::string::npos);
  const auto cloth = io::open_sequence({folder.path() / "cloth"}), body = io::open_sequence({folder.path() / "body"});
  EXPECT_EQ(body->groups().at(1).role, io::Group::Role::kBody);
  const io::Points flat = body->frame(0).points, smooth = cloth->frame(0).points;
  EXPECT_EQ(flat[4], (std::array<double, 3>{1, 0, 1})) << "as it was";
  EXPECT_NE(smooth[4], flat[4]);
  const auto unknown =
      run_program(folder, {"subdivide", folder.path() / "a.obj", "-o", folder.path() / "no", "--body", "bal"});
  EXPECT_EQ(unknown.exit_code, 2);
}

/// A face one rounding unit wide: two corners of it have no midpoint between them.
TEST(SubdivideCommand, AFaceTooThinForItsMidpointsIsNamedAsInTheInput) {
  const TemporaryFolder folder;
  io::MeshData mesh;
  for (std::int32_t k = 0; k < 4; ++k) {
    const double beside = k == 3 ? std::nextafter(1.0, 2.0) : 1.5;
    mesh.points.insert(mesh.points.end(), {{1, 0, 1.0 * k}, {beside, 0, 1.0 * k}, {1, 1, 1.0 * k}});
    mesh.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  io::SequenceWriter(folder.path() / "run",
                     {mesh.triangles, {}, io::SequenceKind::kFrames, io::Precision::kFloat64, "test"})
      .append(0, mesh.points);
  for (const char* levels : {"1", "3"}) {
    const auto result =
        run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "fine", "--levels", levels});
    EXPECT_EQ(result.exit_code, 1) << result.out;
    expect_text(result.err, "within face 3, which is too thin for the rounding of its midpoints");
    EXPECT_FALSE(fs::exists(folder.path() / "fine"));
  }
}

TEST(SubdivideCommand, WhatCannotBeSubdividedIsNamedAndLeavesNothing) {
  const TemporaryFolder folder;
  spit(folder.path() / "first.obj", kTriangle);
  const struct {
    const char *name, *mesh, *message;
  } cases[] = {
      {"more.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nf 1 2 3\n", "4 vertices, the first frame has 3"},
      {"turned.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n", "its faces are not those of the first frame"},
      {"nan.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", "nan"},
      {"huge.obj", "v 0 0 0\nv 1 0 0\nv 0 -1e308 0\nf 1 2 3\n",
       "vertex 2 has the coordinate -1e+308, beyond 1.07151e+301"},
      {"none.ply",
       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 0\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n",
       "1 vertices, the first frame has 3"},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.name);
    spit(folder.path() / c.name, c.mesh);
    const auto result = run_program(
        folder, {"subdivide", folder.path() / "first.obj", folder.path() / c.name, "-o", folder.path() / "fine"});
    EXPECT_EQ(result.exit_code, 3) << result.out;
    expect_text(result.err, c.name);
    expect_text(result.err, c.message);
    EXPECT_FALSE(fs::exists(folder.path() / "fine"));
  }
  const auto none = run_program(folder, {"subdivide", folder.path() / "none.ply", "-o", folder.path() / "fine"});
  EXPECT_EQ(none.exit_code, 3);
  expect_text(none.err, "none.ply: no faces: there is nothing to subdivide");
  EXPECT_FALSE(fs::exists(folder.path() / "fine"));
}

TEST(SubdivideCommand, MoreFacesThanAMeshMayHaveAreRefusedBeforeAnyWork) {
  const TemporaryFolder folder;
  const io::Triangles triangles(175'000, {0, 1, 2});  // 716,800,000 in the end
  io::SequenceWriter writer(folder.path() / "run",
                            {triangles, {}, io::SequenceKind::kFrames, io::Precision::kFloat64, "test"});
  writer.append(0, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const auto result =
      run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "fine", "--levels", "6"});
  EXPECT_EQ(result.exit_code, 2) << result.err;
  expect_text(result.err, "--levels 6: 175000 faces would become more than 715827882");
  EXPECT_FALSE(fs::exists(folder.path() / "fine"));
}

TEST(SubdivideCommand, SaysWhatItDidNotCheck) {
  const TemporaryFolder folder;
  using Role = io::Group::Role;
  const io::Triangles triangles = {{0, 1, 2}, {3, 4, 5}};
  for (const Role second : {Role::kCloth, Role::kBody}) {
    const fs::path name = folder.path() / (second == Role::kBody ? "bodies" : "both");
    io::SequenceWriter(name, {triangles,
                              {{"stone", Role::kBody, 0, 1}, {"other", second, 1, 2}},
                              io::SequenceKind::kFrames,
                              io::Precision::kFloat64,
                              "test"})
        .append(0, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
    const auto result = run_program(folder, {"subdivide", name, "-o", name.string() + "-fine"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    expect_text(result.out, second == Role::kBody ? "nothing was smoothed or checked: all faces belong to bodies"
                                                  : "0 intersections; bodies not against each other or themselves");
  }
}

TEST(SubdivideCommand, AFrameAloneHasItsOwnFacesAndGroups) {
  const TemporaryFolder folder;
  spit(folder.path() / "two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\ng both\nf 1 2 3\nf 2 4 3\n");
  spit(folder.path() / "one.obj", std::string("g single\n") + kTriangle);
  const auto result = run_program(folder, {"subdivide", folder.path() / "two.obj", folder.path() / "one.obj", "--frame",
                                           "1", "-o", folder.path() / "fine"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(io::open_sequence({folder.path() / "fine"})->groups().at(0).name, "single");
}

TEST(SubdivideCommand, ADamagedFrameLeavesNothingOfThoseBeforeIt) {
  const TemporaryFolder folder;
  io::SequenceWriter writer(folder.path() / "run",
                            {{{0, 1, 2}}, {}, io::SequenceKind::kFrames, io::Precision::kFloat64, "test"});
  for (int i = 0; i < 100; ++i) writer.append(i, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  spit(folder.path() / "run" / "frame_000099.npy", "damaged");
  const auto result = run_program(folder, {"subdivide", folder.path() / "run", "-o", folder.path() / "fine"});
  EXPECT_EQ(result.exit_code, 3) << result.out;
  expect_text(result.err, "frame_000099.npy");
  EXPECT_FALSE(fs::exists(folder.path() / "fine"));
}

TEST(SubdivideCommand, ASignalEndsTheWorkOnAFrame) {
  const TemporaryFolder folder;
  constexpr int kSide = 20;
  io::MeshData sheet;
  for (int i = 0; i <= kSide; ++i) {
    for (int j = 0; j <= kSide; ++j)
      sheet.points.push_back({double(i), double(j), (7 * i * i + 3 * i * j) % 16 / 32.0});
  }
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const int a = i * (kSide + 1) + j, b = a + kSide + 1;
      sheet.triangles.insert(sheet.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
    }
  }
  io::SequenceWriter writer(folder.path() / "run",
                            {sheet.triangles, {}, io::SequenceKind::kFrames, io::Precision::kFloat64, "test"});
  writer.append(0, sheet.points);
  const pid_t child = testing::start_program(
      folder.path(), {"subdivide", folder.path() / "run", "-o", folder.path() / "fine", "--levels", "6"});
  for (int i = 0; i < 60000 && !fs::exists(folder.path() / "fine" / "frames.jsonl"); ++i) usleep(1000);
  usleep(200'000);  // the only frame is begun, and takes seconds
  kill(child, SIGTERM);
  const auto result = testing::wait_for_program(folder.path(), child);
  EXPECT_EQ(result.exit_code, 75) << result.out;
  EXPECT_FALSE(fs::exists(folder.path() / "fine"));
}

TEST(SubdivideCommand, AFrameThatIntersectsSaysWhatIsWrongWithItsMesh) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "mesh.obj";
  const std::string second = "f 1 2 3\nv 0 0 0\nv 4 0 0\nv 2 -3 1\nf 4 5 6\n";
  for (const auto& [text, words] :
       {std::pair{"v 0 0 0\nv 4 0 0\nv 2 3 0\n" + second, "corners of them lie at one place, such as vertex 0"},
        {std::string("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 1 2 3 4 5\n"),
         "faces 0 and 1 go around one corner, as those of a polygon do"},
        {std::string("v 0 0 0\nv 4 0 0\nv 2 3 0\nf 1 2 3\nv 1 1 1\nv 1 1 -1\nv 5 5 0\nf 4 5 6\n"), "free the frame"}}) {
    spit(mesh, text);
    const auto run = testing::run_program(folder, {"subdivide", mesh, "-o", folder.path() / "fine"});
    EXPECT_EQ(run.exit_code, 1) << run.err;
    expect_text(run.err, words);
    EXPECT_FALSE(fs::exists(folder.path() / "fine"));
  }
}

TEST(SubdivideCommand, AnInterruptedRunLeavesNothing) {
  const TemporaryFolder folder;
  io::SequenceWriter writer(folder.path() / "run",
                            {{{0, 1, 2}}, {}, io::SequenceKind::kFrames, io::Precision::kFloat64, "test"});
  for (int i = 0; i < 300; ++i) writer.append(i, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    const pid_t child = testing::start_program(
        folder.path(), {"subdivide", folder.path() / "run", "-o", folder.path() / "fine", "--levels", "5"});
    for (int i = 0; i < 6000 && !fs::exists(folder.path() / "fine" / "frame_000000.npy"); ++i) usleep(1000);
    kill(child, signal);
    const auto result = testing::wait_for_program(folder.path(), child);
    EXPECT_EQ(result.exit_code, 75) << result.out;
    expect_text(result.err, "interrupted; nothing was written");
    EXPECT_FALSE(fs::exists(folder.path() / "fine"));
  }
}

}  // namespace selvage
