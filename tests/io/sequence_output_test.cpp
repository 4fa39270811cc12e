#include "io/sequence_output.h"

#include <gtest/gtest.h>

// gtest before RapidCheck's bridge
#include <cmath>
#include <csignal>
#include <stdexcept>
#include <string>

#include <rapidcheck/gtest.h>
#include <sys/resource.h>

#include "io/file/byte_order.h"
#include "io/file/checksum.h"
#include "io/mesh_reader.h"
#include "io/sequence/sequence_outputs.h"
#include "tests/io/random_doubles.h"
#include "tests/io/support.h"
#include "tests/property.h"

namespace selvage::io {
namespace {

namespace fs = std::filesystem;
using testing::expect_error;
using testing::same_bits;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

const Triangles kTriangles = {{0, 1, 2}, {2, 1, 0}, {1, 0, 2}, {0, 2, 1}};
const std::vector<Group> kGroups = {{"left sleeve", Group::Role::kCloth, 0, 1},
                                    {"ball \xc3\xa9", Group::Role::kBody, 1, 4}};

MeshData mesh_of(Points points) { return {std::move(points), kTriangles, kGroups, Precision::kFloat64}; }

/// Three frames of three points or more, the same number in all.
std::vector<Points> draw_frames() {
  Points all = *testing::finite_points();
  if (all.size() < 9) all.resize(9, {-0.0, 0x1p-1074, 1e300});
  const std::size_t count = all.size() / 3;
  std::vector<Points> frames;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(i * count);
    frames.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(count));
  }
  return frames;
}

std::unique_ptr<SequenceOutput> create(const fs::path& target, const std::vector<Points>& frames,
                                       Precision precision = Precision::kFloat64) {
  return create_output(
      target, {{kTriangles, kGroups, SequenceKind::kSteps, precision, "test"}, frames.front().size(), frames.size()});
}

std::unique_ptr<SequenceReader> write_and_open(const fs::path& target, const std::vector<Points>& frames,
                                               Precision precision = Precision::kFloat64) {
  const auto output = create(target, frames, precision);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    output->append(0.25 * static_cast<double>(i), {frames[i], kTriangles, kGroups, precision});
  }
  output->finish();
  return open_sequence(output->sources());
}

void assert_same(const SequenceReader& reader, const std::vector<Points>& frames) {
  RC_ASSERT(reader.frame_count() == frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const MeshData mesh = reader.frame(i);
    RC_ASSERT(same_bits(mesh.points, frames[i]));
    RC_ASSERT(mesh.triangles == kTriangles);
  }
}

class Float64Output : public ::testing::TestWithParam<std::string> {};

TEST_P(Float64Output, prop_every_double_comes_back) {
  testing::check_property(15, 1, [] {
    const TemporaryFolder folder;
    const std::vector<Points> frames = draw_frames();
    assert_same(*write_and_open(folder / GetParam(), frames), frames);
  });
}

INSTANTIATE_TEST_SUITE_P(All, Float64Output, ::testing::Values("a.npz", "a.obj", "a/"),
                         [](const auto& of) { return of.param == "a/" ? std::string("folder") : of.param.substr(2); });

class Float32Output : public ::testing::TestWithParam<std::string> {};

TEST_P(Float32Output, prop_the_float32_lattice_comes_back) {
  testing::check_property(15, 2, [] {
    const TemporaryFolder folder;
    std::vector<Points> frames = draw_frames();
    for (Points& points : frames) {
      for (auto& point : points) {
        for (double& x : point) x = testing::to_lattice(x);
      }
    }
    const auto reader = write_and_open(folder / GetParam(), frames, Precision::kFloat32);
    RC_ASSERT(reader->precision() == Precision::kFloat32);
    assert_same(*reader, frames);
  });
}

INSTANTIATE_TEST_SUITE_P(All, Float32Output, ::testing::Values("a.npz", "a.pc2", "a/"),
                         [](const auto& of) { return of.param == "a/" ? std::string("folder") : of.param.substr(2); });

const std::vector<Points> kTwoFrames = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}}, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1.5}}};

TEST(SequenceOutput, TraitsAreTrue) {
  for (const std::string name : {"a.npz", "a.obj", "a.pc2", "folder"}) {
    SCOPED_TRACE(name);
    const TemporaryFolder folder;
    const auto reader = write_and_open(folder / name, kTwoFrames);
    const OutputTraits& kept = traits(output_format(folder / name));
    EXPECT_EQ(reader->precision() == Precision::kFloat32, kept.is_float32);
    EXPECT_EQ(reader->time(1) == 0.25, kept.keeps_times);
    EXPECT_EQ(reader->kind() == SequenceKind::kSteps, kept.keeps_kind);
    ASSERT_EQ(reader->groups().size(), 2u);
    EXPECT_EQ(reader->groups()[1].role == Group::Role::kBody, kept.keeps_roles);
    EXPECT_EQ(reader->groups()[1].name == kGroups[1].name, kept.keeps_group_names);
    EXPECT_EQ(reader->groups()[1].face_begin, 1);
    EXPECT_EQ(reader->groups()[1].face_end, 4);
  }
}

TEST(SequenceOutput, FilesHaveTheNamesThatAreSaid) {
  const TemporaryFolder folder;
  (void)write_and_open(folder / "many.obj", kTwoFrames);
  (void)write_and_open(folder / "one.obj", {kTwoFrames[0]});
  (void)write_and_open(folder / "cache.pc2", kTwoFrames);
  for (const char* name : {"many_000000.obj", "many_000001.obj", "one.obj", "cache.pc2", "cache.obj"}) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 5);
  EXPECT_EQ(output_format("x/"), OutputFormat::kFolder);
  EXPECT_EQ(output_format("x.y/"), OutputFormat::kFolder);
  EXPECT_EQ(output_format("x"), OutputFormat::kFolder);
  EXPECT_EQ(output_format("x.OBJ"), OutputFormat::kObj);
  for (const char* name : {"x.ply", "x.mdd", "x.vtp", "x.y"}) {
    expect_error(ErrorKind::kBadInput, "the extension is none that is written", [&] { (void)output_format(name); });
  }
}

TEST(SequenceOutput, FacesThatDoNotExistAreRefused) {
  const TemporaryFolder folder;
  for (const char* name : {"a.npz", "a.obj", "a.pc2", "a.pvd", "a/"}) {
    for (const auto& [begin, end] : {std::pair(-1, 1), {0, 5}, {2, 1}}) {
      OutputHeader header{{}, 3};
      header.sequence.triangles = kTriangles;
      header.sequence.groups = {{"sleeve", Group::Role::kBody, begin, end}};
      expect_error(ErrorKind::kBadInput, "the group \"sleeve\" names faces that do not exist",
                   [&] { static_cast<void>(create_output(folder.path() / name, header)); });
    }
    OutputHeader header{{}, 3};
    header.sequence.triangles = {{0, 1, 3}};
    expect_error(ErrorKind::kBadInput, "a vertex that does not exist",
                 [&] { static_cast<void>(create_output(folder.path() / name, header)); });
    header.sequence.triangles = kTriangles;
    header.sequence.groups = {{"sleeve", Group::Role::kCloth, 0, 2}, {"arm", Group::Role::kBody, 1, 4}};
    expect_error(ErrorKind::kBadInput, "face 1 is in the group \"sleeve\", which is cloth, and in \"arm\"",
                 [&] { static_cast<void>(create_output(folder.path() / name, header)); });
    header.sequence.groups.clear();
    header.sequence.triangles.clear();
    expect_error(ErrorKind::kBadInput, "no face",
                 [&] { static_cast<void>(create_output(folder.path() / name, header)); });
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(SequenceOutput, FramesThatCannotBeAreRefused) {
  const Points points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (const char* name : {"a.npz", "a.obj", "a.pc2", "a.pvd", "a/"}) {
    const TemporaryFolder folder;
    const auto output = create(folder.path() / name, {points, points});
    const auto refuse = [&](double time_s, const MeshData& mesh, const std::string& words) {
      expect_error(ErrorKind::kBadInput, words, [&] { output->append(time_s, mesh); });
    };
    MeshData bad = mesh_of(points);
    bad.points[1][2] = std::numeric_limits<double>::quiet_NaN();
    refuse(0, bad, "vertex 1 of frame 0 is not finite");
    if (name == std::string("a.pc2")) {
      bad.points[1][2] = 0.1;
      refuse(0, bad, "float32");
    }
    bad = mesh_of(points);
    bad.triangles[0][0] = 3;
    refuse(0, bad, "a vertex that does not exist");
    refuse(std::numeric_limits<double>::infinity(), mesh_of(points), "frame 0 is no later");
    output->append(0.5, mesh_of(points));
    refuse(0.5, mesh_of(points), "frame 1 is no later than the one before");
    expect_error(ErrorKind::kBadInput, "1 frames were written, and 2 announced", [&] { output->finish(); });
    output->append(0.75, mesh_of(points));
    refuse(1, mesh_of(points), "frame 2 is one more than were announced");
    output->finish();
    EXPECT_FALSE(fs::is_empty(folder.path())) << name;
    refuse(1, mesh_of(points), "is finished");
    expect_error(ErrorKind::kBadInput, "is finished", [&] { output->finish(); });
    if (name == std::string("a.pvd")) continue;  // which is not read
    const auto reader = open_sequence(output->sources());
    EXPECT_EQ(reader->frame(1).points, points) << name;
    EXPECT_THROW((void)reader->frame(2), std::out_of_range) << name;
  }
}

/// Files may not grow beyond so many bytes while it lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = SIG_DFL;
};

// A frame of which half is on disk, and then another behind it, would be a file of shifted frames.
TEST(SequenceOutput, AfterAFailureOfTheFileNothingFollows) {
  const Points many(2000, {0, 1, 2});
  for (const char* name : {"a.npz", "a.pc2", "a.obj", "a.pvd", "a/"}) {
    const TemporaryFolder folder;
    {
      const auto output = create(folder.path() / name, {many, many});
      {
        const FileSizeLimit limit(4096);
        expect_error(ErrorKind::kFile, "a", [&] { output->append(0, mesh_of(many)); });
      }
      expect_error(ErrorKind::kFile, "start anew", [&] { output->append(1, mesh_of(many)); });
      expect_error(ErrorKind::kFile, "start anew", [&] { output->finish(); });
    }
    EXPECT_TRUE(fs::is_empty(folder.path())) << name;
  }
}

TEST(SequenceOutput, NothingIsOverwritten) {
  const struct {
    const char *target, *present;
  } cases[] = {{"a.npz", "a.npz"}, {"a.obj", "a_000001.obj"}, {"a.pc2", "a.pc2"}, {"a.pc2", "a.obj"},
               {"a.pvd", "a.pvd"}, {"a.pvd", "a_000001.vtp"}, {"a", "a"}};
  for (const auto& c : cases) {
    const TemporaryFolder folder;
    spit(folder / c.present, "mine");
    expect_error(ErrorKind::kFile, std::string(c.present) + ": is there already", [&] {
      const auto output = create(folder / c.target, kTwoFrames);
      output->append(0, mesh_of(kTwoFrames[0]));
      output->append(1, mesh_of(kTwoFrames[1]));
      output->finish();
    });
    EXPECT_EQ(slurp(folder / c.present), "mine");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1) << c.target;
  }
  const TemporaryFolder folder;
  spit(folder / "mine", "mine");
  expect_error(ErrorKind::kFile, "is a folder that is not empty", [&] { (void)create(folder.path(), kTwoFrames); });
  EXPECT_EQ(slurp(folder / "mine"), "mine");
}

// Whoever made them has been told nothing, and reads them as his own.
TEST(SequenceOutput, WhatOthersMakeMeanwhileStays) {
  const struct {
    const char *target, *made;
  } cases[] = {{"a.npz", "a.npz"}, {"a.obj", "a_000001.obj"}, {"a.pc2", "a.pc2"},    {"a.pc2", "a.obj"},
               {"a.pvd", "a.pvd"}, {"a.pvd", "a_000001.vtp"}, {"a", "sequence.json"}};
  for (const auto& c : cases) {
    for (const bool is_finished : {true, false}) {
      SCOPED_TRACE(std::string(c.target) + (is_finished ? ", finished, " : ", given up, ") + c.made);
      const TemporaryFolder folder;
      const fs::path made = c.target == std::string("a") ? folder / "a" / c.made : folder / c.made;
      {
        const auto output = create(folder / c.target, kTwoFrames);
        spit(made, "theirs");
        const auto write_all = [&] {
          output->append(0, mesh_of(kTwoFrames[0]));
          output->append(1, mesh_of(kTwoFrames[1]));
          output->finish();
        };
        if (is_finished) expect_error(ErrorKind::kFile, std::string(c.made) + ": is there already", write_all);
      }
      EXPECT_EQ(slurp(made), "theirs");
      EXPECT_EQ(std::distance(fs::directory_iterator(made.parent_path()), {}), 1);
    }
  }
}

TEST(SequenceOutput, AFolderIsNoSequenceBeforeItIsWhole) {
  const TemporaryFolder folder;
  const auto output = create(folder / "a", kTwoFrames);
  output->append(0, mesh_of(kTwoFrames[0]));
  expect_error(ErrorKind::kBadInput, "a folder without sequence.json", [&] { (void)open_sequence({folder / "a"}); });
  output->append(1, mesh_of(kTwoFrames[1]));
  expect_error(ErrorKind::kBadInput, "a folder without sequence.json", [&] { (void)open_sequence({folder / "a"}); });
  output->finish();
  EXPECT_EQ(open_sequence({folder / "a"})->frame_count(), 2U);
}

TEST(SequenceOutput, OfWhatFailsNothingIsLeft) {
  MeshData other_faces = mesh_of(kTwoFrames[1]), other_vertices = mesh_of(kTwoFrames[1]);
  std::swap(other_faces.triangles[0][0], other_faces.triangles[0][1]);
  other_vertices.points.push_back({2, 2, 2});
  for (const char* name : {"a.npz", "a.pc2", "a"}) {
    for (const MeshData& other : {other_faces, other_vertices}) {
      const TemporaryFolder folder;
      expect_error(ErrorKind::kBadInput, "change between frames", [&] {
        const auto output = create(folder / name, kTwoFrames);
        output->append(0, mesh_of(kTwoFrames[0]));
        output->append(1, other);
      });
      EXPECT_TRUE(fs::is_empty(folder.path())) << name;
    }
  }
  for (const char* name : {"a.npz", "a.pc2", "a", "a/", "a/b/c", "a.obj", "a.pvd"}) {
    const TemporaryFolder folder;
    create(folder / name, kTwoFrames)->append(0, mesh_of(kTwoFrames[0]));  // never finished
    EXPECT_TRUE(fs::is_empty(folder.path())) << name;
  }
}

TEST(SequenceOutput, AFolderThatWasThereStaysThere) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "empty");
  fs::create_directory_symlink("empty", folder / "link");
  create(folder / "link", kTwoFrames)->append(0, mesh_of(kTwoFrames[0]));  // never finished
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_TRUE(fs::is_empty(folder / "empty"));
}

TEST(SequenceOutput, WhatOthersPutBesideAFailureStays) {
  for (const char* name : {"out/a/", "out/"}) {
    const TemporaryFolder folder;
    {
      const auto output = create(folder / name, kTwoFrames);
      output->append(0, mesh_of(kTwoFrames[0]));
      (void)write_and_open(folder / "out" / "b", kTwoFrames);
      spit(folder / "out" / "render.log", "note");
    }
    EXPECT_EQ(open_sequence({folder / "out" / "b"})->frame_count(), 2U) << name;
    EXPECT_EQ(slurp(folder / "out" / "render.log"), "note") << name;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out"), {}), 2) << name;
  }
}

TEST(SequenceOutput, GroupsThatChangeAreRefusedWhereTheyAreHeldOnce) {
  MeshData renamed = mesh_of(kTwoFrames[1]), other_body = renamed;
  renamed.groups[0].name = "right sleeve";
  other_body.groups[0].role = Group::Role::kBody;
  const auto append = [](const fs::path& target, const MeshData& second) {
    const auto output = create(target, kTwoFrames);
    output->append(0, mesh_of(kTwoFrames[0]));
    output->append(1, second);
    output->finish();
  };
  const TemporaryFolder folder;
  for (const char* name : {"a", "a.pc2"}) {
    expect_error(ErrorKind::kBadInput, "the groups change between frames; write .obj",
                 [&] { append(folder / name, renamed); });
  }
  expect_error(ErrorKind::kBadInput, "which faces are bodies changes between frames; write .pvd",
               [&] { append(folder / "a.npz", other_body); });
  append(folder / "a.npz", renamed);  // it holds no names
  append(folder / "a.obj", renamed);
  EXPECT_EQ(open_sequence({folder / "a_000001.obj"})->groups()[0].name, "right sleeve");
  append(folder / "a.pvd", other_body);
}

TEST(SequenceOutput, GroupsThatNoNpzHoldsAreRefusedBeforeAnythingIsWritten) {
  const TemporaryFolder folder;
  const auto create_with = [&](std::int32_t changes) {
    OutputHeader header{{}, 3, 1};
    header.sequence.triangles.assign(static_cast<std::size_t>(changes), {0, 1, 2});
    for (std::int32_t i = 1; i < changes; i += 2) header.sequence.groups.push_back({"b", Group::Role::kBody, i, i + 1});
    return create_output(folder / "a.npz", header);
  };
  EXPECT_NO_THROW((void)create_with(4096));
  expect_error(ErrorKind::kBadInput, "a.npz: cloth and bodies alternate 4097 times over the faces, which no .npz holds",
               [&] { (void)create_with(4097); });
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

/// Without the directory at the end, as one reads from a pipe.
TEST(SequenceOutput, NpzCanBeReadAsAStream) {
  const TemporaryFolder folder;
  (void)write_and_open(folder / "a.npz", kTwoFrames);
  const std::string bytes = slurp(folder / "a.npz");
  const auto little = [&]<typename T>(std::size_t at, T) { return load<T>(bytes.data() + at, std::endian::little); };
  std::size_t at = 0;
  std::vector<std::string> names;
  while (bytes.compare(at, 4, "PK\x03\x04") == 0) {
    const std::size_t name_size = little(at + 26, std::uint16_t{}), extra_size = little(at + 28, std::uint16_t{});
    names.push_back(bytes.substr(at + 30, name_size));
    const std::size_t extra = at + 30 + name_size, data = extra + extra_size;
    EXPECT_EQ(little(extra, std::uint16_t{}), 1) << "the 64-bit sizes";
    const std::uint64_t size = little(extra + 4, std::uint64_t{});
    EXPECT_EQ(little(extra + 12, std::uint64_t{}), size);
    ASSERT_LE(size, bytes.size() - data);
    EXPECT_EQ(little(at + 14, std::uint32_t{}), crc32(bytes.substr(data, size))) << names.back();
    at = data + size;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"F.npy", "group.npy", "V.npy"}));
  EXPECT_EQ(bytes.compare(at, 4, "PK\x01\x02"), 0) << "the directory does not follow";
}

TEST(SequenceOutput, PvdNamesEveryFrameWithItsTimeToTheBit) {
  const TemporaryFolder folder;
  const auto output = create(folder / "a.pvd", kTwoFrames);
  output->append(0.1, mesh_of(kTwoFrames[0]));
  output->append(1e300, mesh_of(kTwoFrames[1]));
  output->finish();
  const std::string list = slurp(folder / "a.pvd");
  EXPECT_NE(list.find("timestep=\"0.1\" part=\"0\" file=\"a_000000.vtp\""), std::string::npos) << list;
  EXPECT_NE(list.find("timestep=\"1e+300\" part=\"0\" file=\"a_000001.vtp\""), std::string::npos) << list;
}

TEST(SequenceOutput, Pc2NeverRounds) {
  const TemporaryFolder folder;
  const auto output = create(folder / "a.pc2", kTwoFrames);
  expect_error(ErrorKind::kBadInput, "a.pc2: vertex 2 is not on the float32 lattice", [&] {
    output->append(0, mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0.1}}));
  });
}

TEST(SequenceOutput, ObjHoldsAMeshAFrame) {
  const TemporaryFolder folder;
  const auto output = create(folder / "a.obj", kTwoFrames);
  output->append(0, mesh_of(kTwoFrames[0]));
  output->append(1, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}}, {{3, 1, 0}}, {}, Precision::kFloat64});
  output->finish();
  const auto reader = open_sequence(output->sources());
  EXPECT_EQ(reader->frame(0).triangles, kTriangles);
  EXPECT_EQ(reader->frame(1).triangles, (Triangles{{3, 1, 0}}));
}

TEST(ObjBytes, NumbersAreTheShortestThatAreExact) {
  const MeshData mesh = {
      {{0.1, -0.0, 5e-324}, {1, 1e300, 0.30000000000000004}, {7, 8, 9}}, {{0, 1, 2}}, {}, Precision::kFloat64};
  EXPECT_EQ(obj_bytes(mesh, "a"), "v 0.1 -0 5e-324\nv 1 1e+300 0.30000000000000004\nv 7 8 9\nf 1 2 3\n");
}

TEST(ObjBytes, FacesBetweenGroupsAreDefault) {
  MeshData mesh = mesh_of(kTwoFrames[0]);
  mesh.groups = {{"late", Group::Role::kCloth, 2, 3}, {"none", Group::Role::kCloth, 1, 1}};
  const std::vector<Group> read = parse_obj(obj_bytes(mesh, "a"), "a").groups;
  const std::vector<Group> expected = {{"default", Group::Role::kCloth, 0, 2},
                                       {"late", Group::Role::kCloth, 2, 3},
                                       {"default", Group::Role::kCloth, 3, 4}};
  EXPECT_EQ(read, expected);
}

TEST(ObjBytes, FacesOfNoGroupDoNotJoinAGroupNamedDefault) {
  MeshData mesh = mesh_of(kTwoFrames[0]);
  mesh.groups = {{"default", Group::Role::kCloth, 2, 3}, {"default_2", Group::Role::kCloth, 3, 3}};
  std::vector<Group> expected = {{"default_2", Group::Role::kCloth, 0, 2},
                                 {"default", Group::Role::kCloth, 2, 3},
                                 {"default_2", Group::Role::kCloth, 3, 4}};
  EXPECT_EQ(parse_obj(obj_bytes(mesh, "a"), "a").groups, expected) << "a group without faces takes no name";
  mesh.groups[1].face_end = 4;
  expected = {{"default_3", Group::Role::kCloth, 0, 2},
              {"default", Group::Role::kCloth, 2, 3},
              {"default_2", Group::Role::kCloth, 3, 4}};
  EXPECT_EQ(parse_obj(obj_bytes(mesh, "a"), "a").groups, expected);
}

TEST(ObjBytes, WhatObjCannotSayIsRefused) {
  MeshData mesh = mesh_of(kTwoFrames[0]);
  for (const char* name : {"two\nlines", "carriage\r", " blank", "\xff", "continued\\"}) {
    mesh.groups = {{name, Group::Role::kCloth, 0, 4}};
    expect_error(ErrorKind::kBadInput, "does not fit into a line of OBJ", [&] { (void)obj_bytes(mesh, "a"); });
  }
  mesh.groups = {{"a", Group::Role::kCloth, 0, 3}, {"b", Group::Role::kCloth, 2, 4}};
  expect_error(ErrorKind::kBadInput, "two groups share a face", [&] { (void)obj_bytes(mesh, "a"); });
}

}  // namespace
}  // namespace selvage::io
