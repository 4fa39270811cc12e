#include "io/sequence.h"

#include <algorithm>
#include <array>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "io/file/atomic_file.h"
#include "io/format/npy.h"
#include "io/sequence/sequence_json.h"
#include "tests/io/support.h"

namespace selvage::io {
namespace {

namespace fs = std::filesystem;
using testing::expect_error;
using testing::same_bits;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

SequenceHeader square_header() {
  return {.triangles = {{0, 1, 2}, {0, 2, 3}},
          .groups = {{"shirt", Group::Role::kCloth, 0, 1}, {"ball \xc3\xa9", Group::Role::kBody, 1, 2}},
          .kind = SequenceKind::kSteps,
          .precision = Precision::kFloat64,
          .producer = "test 1"};
}

Points square(double height) {
  return {{0, 0, height}, {1, -0.0, height}, {1, 1, 0x1p-1074}, {std::numeric_limits<double>::max(), 1, 0.1}};
}

TEST(SequenceFolder, WhatIsWrittenIsRead) {
  const TemporaryFolder folder;
  const fs::path sequence = folder / "run/deep";
  {
    SequenceWriter writer(sequence, square_header());
    for (int i = 0; i < 3; ++i) writer.append(0.1 * i, square(i));
    EXPECT_EQ(writer.frame_count(), 3u);
  }
  const auto reader = open_sequence({sequence});
  ASSERT_EQ(reader->frame_count(), 3u);
  EXPECT_EQ(reader->kind(), SequenceKind::kSteps);
  EXPECT_EQ(reader->precision(), Precision::kFloat64);
  EXPECT_EQ(reader->groups(), square_header().groups);
  for (std::size_t i = 0; i < 3; ++i) {
    const MeshData mesh = reader->frame(i);
    EXPECT_TRUE(same_bits(mesh.points, square(static_cast<double>(i))));
    EXPECT_EQ(mesh.triangles, square_header().triangles);
    EXPECT_EQ(mesh.groups, square_header().groups);
    EXPECT_EQ(reader->time(i), 0.1 * static_cast<double>(i));
    EXPECT_TRUE(reader->same_faces_as_previous(i));
  }
  EXPECT_EQ(reader->frame_name(2), (sequence / "frame_000002.npy").string());
}

TEST(SequenceFolder, Float32IsStoredAsFloat32AndNeverRounded) {
  const TemporaryFolder folder;
  SequenceHeader header = square_header();
  header.precision = Precision::kFloat32;
  SequenceWriter writer(folder.path(), header);
  const Points lattice = {{0.5, -0.0, 0x1p-149}, {static_cast<double>(0.1f), 1, 2}, {3, 4, 0x1.fffffep127}, {5, 6, 7}};
  writer.append(0, lattice);
  EXPECT_TRUE(same_bits(open_sequence({folder.path()})->frame(0).points, lattice));
  for (const double between : {0.1, 1e300, 0x1p-150}) {
    Points points = lattice;
    points[2][1] = between;
    expect_error(ErrorKind::kBadInput, "vertex 2 is not on the float32 lattice", [&] { writer.append(1, points); });
  }
  EXPECT_EQ(open_sequence({folder.path()})->frame_count(), 1u);
}

TEST(SequenceFolder, EmptyRunIsAValidSequenceOfNoFrames) {
  const TemporaryFolder folder;
  const SequenceWriter writer(folder.path(), square_header());
  EXPECT_EQ(open_sequence({folder.path()})->frame_count(), 0u);
}

TEST(SequenceFolder, ResumeContinuesWithTheSameBytes) {
  const TemporaryFolder whole, resumed;
  {
    SequenceWriter writer(whole.path(), square_header());
    for (int i = 0; i < 4; ++i) writer.append(i, square(i));
  }
  {
    SequenceWriter writer(resumed.path(), square_header());
    for (int i = 0; i < 3; ++i) writer.append(i, square(i == 2 ? 77 : i));
  }
  spit(resumed / "frame_000003.npy.tmp-42", "torn");
  spit(resumed / "report.json.tmp-42", "not ours");
  {
    SequenceWriter writer(resumed.path(), square_header(), true);
    EXPECT_EQ(writer.frame_count(), 3u);
    writer.truncate(2);
    EXPECT_EQ(writer.frame_count(), 2u);
    EXPECT_FALSE(fs::exists(resumed / "frame_000002.npy"));
    for (int i = 2; i < 4; ++i) writer.append(i, square(i));
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(whole.path())) {
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(slurp(whole / name), slurp(resumed / name)) << name;
  }
  EXPECT_FALSE(fs::exists(resumed / "frame_000003.npy.tmp-42"));
  EXPECT_TRUE(fs::exists(resumed / "report.json.tmp-42"));
}

TEST(SequenceFolder, ResumeRefusesAnotherRun) {
  const TemporaryFolder folder;
  {
    SequenceWriter writer(folder.path(), square_header());
    writer.append(0, square(0));
  }
  expect_error(ErrorKind::kFile, "holds a sequence already", [&] { SequenceWriter(folder.path(), square_header()); });
  const auto resume_with = [&](const auto& change, const std::string& words) {
    SequenceHeader header = square_header();
    change(header);
    expect_error(ErrorKind::kBadInput, words, [&] { SequenceWriter(folder.path(), header, true); });
  };
  resume_with([](SequenceHeader& header) { header.triangles[1] = {0, 3, 2}; }, "other faces or groups");
  resume_with([](SequenceHeader& header) { header.groups[0].name = "skirt"; }, "other faces or groups");
  resume_with([](SequenceHeader& header) { header.kind = SequenceKind::kFrames; }, "holds every step");
  resume_with([](SequenceHeader& header) { header.precision = Precision::kFloat32; }, "holds float64, and float32");
  resume_with([](SequenceHeader& header) { header.producer = "test 2"; }, "and this is test 2");
  SequenceWriter writer(folder.path(), square_header(), true);
  expect_error(ErrorKind::kBadInput, "lists 1 frames, 2 are needed", [&] { writer.truncate(2); });
}

// Frames are read once before a run goes on: it must not end as complete with some that nobody can read.
TEST(SequenceFolder, ResumeRefusesFramesThatAreNotThoseRecorded) {
  const TemporaryFolder folder;
  {
    SequenceWriter writer(folder.path(), square_header());
    for (int i = 0; i < 3; ++i) writer.append(i, square(i));
  }
  const auto resume = [&] { SequenceWriter(folder.path(), square_header(), true); };
  EXPECT_NO_THROW(resume());
  const fs::path frame = folder / "frame_000001.npy";
  const std::string recorded = slurp(frame);
  spit(frame, npy_bytes(square(7), Precision::kFloat64, "a"));
  expect_error(ErrorKind::kBadInput, "frame_000001.npy: the checksum differs from the one recorded", resume);
  spit(frame, recorded);
  // Other programs may list frames without checksums.
  spit(folder / "frames.jsonl", "{\"file\":\"frame_000000.npy\"}\n{\"file\":\"frame_000001.npy\"}\n");
  EXPECT_NO_THROW(resume());
  Points more = square(1);
  more.push_back({5, 5, 5});
  spit(frame, npy_bytes(more, Precision::kFloat64, "a"));
  expect_error(ErrorKind::kBadInput, "frame_000001.npy: has another number of vertices than the first frame", resume);
}

// Of vertices without a face there may be more in the run that starts anew.
TEST(SequenceFolder, WithoutFramesAnyNumberOfVerticesMayFollow) {
  const TemporaryFolder folder;
  { SequenceWriter(folder.path(), square_header()).append(0, square(0)); }
  Points more = square(1);
  more.push_back({5, 5, 5});
  SequenceWriter writer(folder.path(), square_header(), true);
  expect_error(ErrorKind::kBadInput, "5 vertices do not match", [&] { writer.append(1, more); });
  writer.truncate(0);
  writer.append(1, more);
  EXPECT_EQ(open_sequence({folder.path()})->frame(0).points.size(), 5u);
}

TEST(SequenceFolder, OneWriterAFolder) {
  const TemporaryFolder folder;
  const SequenceWriter writer(folder.path(), square_header());
  expect_error(ErrorKind::kFile, "another run", [&] { SequenceWriter(folder.path(), square_header(), true); });
}

TEST(SequenceFolder, AppendRefusesBadFrames) {
  const TemporaryFolder folder;
  SequenceWriter writer(folder.path(), square_header());
  expect_error(ErrorKind::kBadInput, "3 vertices", [&] { writer.append(0, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}); });
  writer.append(1, square(0));
  Points five = square(1);
  five.push_back({0, 0, 0});
  expect_error(ErrorKind::kBadInput, "5 vertices", [&] { writer.append(2, five); });
  expect_error(ErrorKind::kBadInput, "not later", [&] { writer.append(1, square(1)); });
  Points nan = square(1);
  nan[3][2] = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorKind::kBadInput, "vertex 3 is not finite", [&] { writer.append(2, nan); });
  writer.append(2, square(1));
  EXPECT_EQ(open_sequence({folder.path()})->frame_count(), 2u);
}

TEST(SequenceFolder, HeadersThatNoReaderTakesAreNotWritten) {
  const TemporaryFolder folder;
  const auto refuse = [&](const std::string& fragment, const auto& change) {
    SequenceHeader header = square_header();
    change(header);
    expect_error(ErrorKind::kBadInput, fragment, [&] { SequenceWriter(folder.path(), header); });
    EXPECT_FALSE(fs::exists(folder / "sequence.json"));
  };
  refuse("no face", [](SequenceHeader& header) { header.triangles.clear(), header.groups.clear(); });
  refuse("repeats a vertex", [](SequenceHeader& header) { header.triangles[0] = {1, 2, 1}; });
  refuse("negative index", [](SequenceHeader& header) { header.triangles[0] = {1, 2, -1}; });
  refuse("the group 'shirt' is not within the 2 faces", [](SequenceHeader& header) { header.groups[0].face_end = 3; });
  refuse("face 0 is in the group \"shirt\", which is cloth, and in \"ball\"", [](SequenceHeader& header) {
    header.groups.push_back({"ball", Group::Role::kBody, 0, 1});
  });
  refuse("not UTF-8", [](SequenceHeader& header) { header.groups[0].name = "caf\xe9"; });
  refuse("not UTF-8", [](SequenceHeader& header) { header.producer = "\xff"; });
  refuse("200001 groups with their names do not fit into sequence.json (16 MiB); join groups, or shorten their names",
         [](SequenceHeader& header) { header.groups.resize(200'001); });
}

TEST(SequenceFolder, NoFaceHasTwoRolesHoweverGroupsOverlap) {
  std::mt19937 random(1);
  int refused = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const std::size_t longest = trial % 2 == 0 ? 4 : 10;  // short ones are rarely within another
    std::vector<Group> groups(random() % 6);
    std::array<std::array<bool, 2>, 10> has = {};  // face, role
    for (Group& group : groups) {
      group.role = random() % 2 == 0 ? Group::Role::kCloth : Group::Role::kBody;
      group.face_begin = static_cast<std::int32_t>(random() % 10);
      group.face_end = std::min<std::int32_t>(10, group.face_begin + static_cast<std::int32_t>(random() % longest));
      for (std::int32_t face = group.face_begin; face < group.face_end; ++face) {
        has.at(static_cast<std::size_t>(face)).at(group.role == Group::Role::kCloth ? 0 : 1) = true;
      }
    }
    const bool is_twice = std::ranges::any_of(has, [](const auto& roles) { return roles[0] && roles[1]; });
    refused += is_twice ? 1 : 0;
    if (is_twice) {
      expect_error(ErrorKind::kBadInput, "which is cloth, and in", [&] { require_one_role(groups, "a"); });
    } else {
      EXPECT_NO_THROW(require_one_role(groups, "a"));
    }
  }
  EXPECT_GT(refused, 200);
}

// What a scene of 10,000 copies makes, beside a body, and what files of garments hold.
TEST(SequenceFolder, ManyGroupsComeBack) {
  const TemporaryFolder folder;
  SequenceHeader header = square_header();
  header.groups.assign(100'000, {"sheet of the row in the wind", Group::Role::kCloth, 0, 1});
  header.groups.push_back({"ball", Group::Role::kBody, 1, 2});
  { SequenceWriter(folder.path(), header).append(0, square(0)); }
  EXPECT_EQ(open_sequence({folder.path()})->groups(), header.groups);
}

TEST(SequenceFolder, AFailedAppendLosesNothingAndTheNextMayWork) {
  const TemporaryFolder folder;
  SequenceWriter writer(folder.path(), square_header());
  writer.append(0, square(0));
  fs::create_directories(folder / "frame_000001.npy/in the way");
  expect_error(ErrorKind::kFile, "frame_000001.npy", [&] { writer.append(1, square(1)); });
  EXPECT_EQ(open_sequence({folder.path()})->frame_count(), 1u);
  fs::remove_all(folder / "frame_000001.npy");
  writer.append(1, square(1));
  EXPECT_TRUE(same_bits(open_sequence({folder.path()})->frame(1).points, square(1)));
}

TEST(SequenceFolder, TornLastLineIsNotPartOfTheList) {
  const TemporaryFolder folder;
  {
    SequenceWriter writer(folder.path(), square_header());
    for (int i = 0; i < 2; ++i) writer.append(i, square(i));
  }
  const std::string list = slurp(folder / "frames.jsonl");
  const std::size_t second = list.find('\n') + 1;
  for (std::size_t length = 0; length <= list.size(); ++length) {
    spit(folder / "frames.jsonl", std::string_view(list).substr(0, length));
    const std::size_t listed = (length >= second) + (length >= list.size());
    EXPECT_EQ(open_sequence({folder.path()})->frame_count(), listed) << length;
  }
  spit(folder / "frames.jsonl", list.substr(0, list.size() - 5));
  SequenceWriter writer(folder.path(), square_header(), true);
  writer.append(1, square(1));
  EXPECT_EQ(slurp(folder / "frames.jsonl"), list);
}

TEST(SequenceFolder, ResumingChangesNothingBeforeTheFirstFrame) {
  const TemporaryFolder folder;
  { SequenceWriter(folder.path(), square_header()).append(0, square(0)); }
  const std::string torn = slurp(folder / "frames.jsonl") + "{";
  spit(folder / "frames.jsonl", torn);
  spit(folder / "frame_000001.npy.tmp-42", "left by a kill");
  SequenceWriter writer(folder.path(), square_header(), true);
  EXPECT_EQ(slurp(folder / "frames.jsonl"), torn) << "whoever resumes may still be refused";
  EXPECT_TRUE(fs::exists(folder / "frame_000001.npy.tmp-42"));
  writer.append(1, square(1));
  EXPECT_EQ(open_sequence({folder.path()})->frame_count(), 2u);
  EXPECT_FALSE(fs::exists(folder / "frame_000001.npy.tmp-42"));
}

TEST(MeshFiles, ChangedFacesAreReported) {
  const TemporaryFolder folder;
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  spit(folder / "a.obj", points + "f 1 2 3\nf 1 3 4\n");
  spit(folder / "b.obj", points + "f 1 2 3 4\n");
  spit(folder / "c.obj", points + "g left\nf 1 2 4\ng right\nf 2 3 4\n");
  const auto reader = open_sequence({folder / "a.obj", folder / "b.obj", folder / "c.obj"});
  ASSERT_EQ(reader->frame_count(), 3u);
  EXPECT_TRUE(reader->same_faces_as_previous(0));
  EXPECT_TRUE(reader->same_faces_as_previous(1)) << "the fan of the quadrangle is the two triangles";
  EXPECT_FALSE(reader->same_faces_as_previous(2));
  EXPECT_EQ(reader->frame(2).groups.size(), 2u);
  EXPECT_EQ(reader->frame_name(1), (folder / "b.obj").string());
  EXPECT_EQ(reader->time(2), 2.0);
  EXPECT_EQ(reader->kind(), SequenceKind::kFrames);
  spit(folder / "d.obj", points);
  expect_error(ErrorKind::kBadInput, "d.obj: no face", [&] {
    (void)open_sequence({folder / "a.obj", folder / "d.obj"});
  });
}

// A recheck and a verdict say of what precision the coordinates are: float64 where one frame is.
TEST(MeshFiles, ThePrecisionIsThatOfTheFrameThatStoresMost) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& real) {
    spit(folder / name, "ply\nformat ascii 1.0\nelement vertex 3\nproperty " + real + " x\nproperty " + real +
                            " y\nproperty " + real + " z\nelement face 1\nproperty list uchar int vertex_indices\n" +
                            "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    return folder / name;
  };
  const fs::path single = write("single.ply", "float"), whole = write("whole.ply", "double");
  EXPECT_EQ(open_sequence({single, single})->precision(), Precision::kFloat32);
  EXPECT_EQ(open_sequence({whole, single})->precision(), Precision::kFloat64);
  EXPECT_EQ(open_sequence({single, whole})->precision(), Precision::kFloat64);
}

TEST(SequenceFolder, FacesThatAreNoneAreNamedWithTheirFile) {
  const TemporaryFolder folder;
  SequenceDescription description;
  description.faces_file = "faces.npy";
  spit(folder / "sequence.json", to_json(description));
  spit(folder / "faces.npy", npy_bytes(Triangles{}));
  spit(folder / "frames.jsonl", "{\"file\":\"a.npy\"}\n");
  spit(folder / "a.npy", npy_bytes(Points{{0, 0, 0}}, Precision::kFloat64, "a"));
  expect_error(ErrorKind::kBadInput, "faces.npy: no face; write the array of the surface's corners, #F by 3",
               [&] { (void)open_sequence({folder.path()}); });
}

TEST(OpenSequence, TimesAreMoreThanTheNumbersOfFrames) {
  const auto has_times_at = [](const std::vector<double>& times) {
    const TemporaryFolder folder;
    SequenceWriter writer(folder.path(), square_header());
    for (const double time : times) writer.append(time, square(time));
    return has_times(*open_sequence({folder.path()}));
  };
  EXPECT_FALSE(has_times_at({0}));
  EXPECT_FALSE(has_times_at({0, 1, 2}));
  EXPECT_FALSE(has_times_at({10, 11, 12})) << "frames of a longer sequence";
  EXPECT_FALSE(has_times_at({-1, 0}));
  EXPECT_TRUE(has_times_at({0, 0.5}));
  EXPECT_TRUE(has_times_at({0.5, 1.5}));
  EXPECT_TRUE(has_times_at({10, 11, 13}));
}

TEST(OpenSequence, WrongSourcesAreNamed) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::kBadInput, "no file", [] { (void)open_sequence({}); });
  expect_error(ErrorKind::kBadInput, "a folder without sequence.json", [&] { (void)open_sequence({folder.path()}); });
  expect_error(ErrorKind::kFile, "missing.obj", [&] { (void)open_sequence({folder / "missing.obj"}); });
  spit(folder / "a.stl", "solid");
  expect_error(ErrorKind::kBadInput, "none of .obj, .ply, .npz", [&] { (void)open_sequence({folder / "a.stl"}); });
  expect_error(ErrorKind::kBadInput, "name it alone", [&] { (void)open_sequence({folder.path(), folder / "a.obj"}); });
}

}  // namespace
}  // namespace selvage::io
