#include <gtest/gtest.h>

#include "io/format/npy.h"
#include "io/sequence/sequence_readers.h"
#include "tests/io/npy_builder.h"
#include "tests/io/support.h"
#include "tests/io/zip_writer.h"

namespace selvage::io {
namespace {

using testing::dictionary;
using testing::doubles;
using testing::expect_error;
using testing::npy;
using testing::numbers;
using testing::same_bits;
using testing::zip;
using testing::ZipEntry;

const Points kFrame = {{0, -0.0, 1}, {0x1p-1074, 1e300, 0.1}, {3, 2, 1}, {0, 0, 0}};
const Triangles kFaces = {{0, 1, 2}, {0, 2, 3}, {1, 2, 3}};

Points scaled_frame(std::size_t i) {
  Points points = kFrame;
  for (auto& point : points) {
    for (double& x : point) x *= static_cast<double>(i + 1);
  }
  return points;
}

/// V of `frames` frames, under a header that shows `shape`.
std::string positions(std::size_t frames, const std::string& shape, bool fortran = false) {
  std::string data;
  for (std::size_t i = 0; i < frames; ++i) data += doubles(scaled_frame(i));
  return npy(dictionary("<f8", shape, fortran), data);
}

std::string group_numbers(std::initializer_list<int> values) {
  return npy(dictionary("<i4", "(" + std::to_string(values.size()) + ",)"), numbers<std::int32_t>(values));
}

std::unique_ptr<SequenceReader> open_bytes(std::string bytes) {
  return open_npz_sequence(in_memory(std::move(bytes)), "a.npz");
}

void expect_bad_npz(const std::string& fragment, const std::string& bytes) {
  expect_error(ErrorKind::kBadInput, fragment, [&] { (void)open_bytes(bytes); });
}

class Npz : public ::testing::TestWithParam<std::tuple<bool, bool>> {
 protected:
  const bool deflate = std::get<0>(GetParam()), zip64 = std::get<1>(GetParam());
};

TEST_P(Npz, FramesFacesAndGroups) {
  const auto reader = open_bytes(zip({{.name = "F.npy", .content = npy_bytes(kFaces), .deflate = deflate},
                                      {.name = "group.npy", .content = group_numbers({0, 1, 1}), .deflate = deflate},
                                      {.name = "other.txt", .content = "not read", .deflate = deflate},
                                      {.name = "V.npy", .content = positions(3, "(3, 4, 3)"), .deflate = deflate}},
                                     zip64));
  ASSERT_EQ(reader->frame_count(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(same_bits(reader->frame(i).points, scaled_frame(i)));
    EXPECT_EQ(reader->frame(i).triangles, kFaces);
  }
  const std::vector<Group> groups = {{"cloth", Group::Role::kCloth, 0, 1}, {"body", Group::Role::kBody, 1, 3}};
  EXPECT_EQ(reader->groups(), groups);
  EXPECT_EQ(reader->frame_name(2), "a.npz[2]");
  EXPECT_EQ(reader->time(2), 2.0);
  EXPECT_EQ(reader->kind(), SequenceKind::kFrames);
  EXPECT_THROW((void)reader->frame(3), std::out_of_range);
}

TEST_P(Npz, OneFrame) {
  const auto reader =
      open_bytes(zip({{.name = "V.npy", .content = npy_bytes(kFrame, Precision::kFloat64, "V"), .deflate = deflate},
                      {.name = "F.npy", .content = npy_bytes(kFaces), .deflate = deflate}},
                     zip64));
  ASSERT_EQ(reader->frame_count(), 1u);
  EXPECT_TRUE(same_bits(reader->frame(0).points, kFrame));
  EXPECT_TRUE(reader->groups().empty());
}

INSTANTIATE_TEST_SUITE_P(All, Npz, ::testing::Combine(::testing::Bool(), ::testing::Bool()));

TEST(NpzInflate, SpansManyChunks) {
  // 7 MB whose deflated form is 50 times smaller: input and output chunks end at different places.
  Points points(300'000);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {static_cast<double>(i % 97), static_cast<double>(i / 4096), 1};
  const std::string bytes = npy_bytes(points, Precision::kFloat64, "V");
  const auto reader = open_bytes(
      zip({{.name = "V.npy", .content = bytes, .deflate = true}, {.name = "F.npy", .content = npy_bytes(kFaces)}}));
  EXPECT_TRUE(same_bits(reader->frame(0).points, points));
}

TEST(NpzHostile, DamagedArchives) {
  const ZipEntry v = {.name = "V.npy", .content = positions(2, "(2, 4, 3)")};
  ZipEntry deflated = v;
  deflated.deflate = true;
  const ZipEntry f = {.name = "F.npy", .content = npy_bytes(kFaces)};
  const auto with = [](ZipEntry entry, const auto& change) {
    change(entry);
    return entry;
  };
  ASSERT_EQ(open_bytes(zip({deflated, f}))->frame_count(), 2u) << "the entries themselves are sound";

  expect_bad_npz("no zip directory", "");
  expect_bad_npz("no member 'F.npy'", zip({v}));
  expect_bad_npz("two members are named 'F.npy'", zip({v, f, f}));
  for (const ZipEntry& entry : {v, deflated}) {
    expect_bad_npz("checksum of 'V.npy' is wrong", zip({with(entry, [](ZipEntry& e) { e.crc32_flip = 1; }), f}));
    expect_bad_npz("not here", zip({with(entry, [](ZipEntry& e) { e.offset_error = 1; }), f}));
    expect_bad_npz("encrypted", zip({with(entry, [](ZipEntry& e) { e.flags = 1; }), f}));
    expect_bad_npz("neither stored nor deflated", zip({with(entry, [](ZipEntry& e) { e.method_shown = 12; }), f}));
  }
  expect_bad_npz("has two sizes", zip({with(v, [](ZipEntry& e) { e.size_error = 1; }), f}));
  expect_bad_npz("'V.npy' ", zip({with(v, [](ZipEntry& e) { e.method_shown = 8; }), f}));
  for (const std::int64_t lie : {-200, -1, 1, 100'000'000}) {
    expect_bad_npz("does not inflate to its size", zip({with(deflated, [&](ZipEntry& e) { e.size_error = lie; }), f}));
  }
  expect_bad_npz("suspiciously many", zip({with(deflated, [](ZipEntry& e) { e.size_error = 1'000'000'000; }), f}));
  expect_bad_npz("suspiciously many",
                 zip({with(deflated, [](ZipEntry& e) { e.size_error = std::int64_t{1} << 40; }), f}, true));
  for (const std::int64_t far : {std::int64_t{1} << 40, std::int64_t{-100}}) {  // the second is nearly 2^64
    expect_bad_npz("not here", zip({with(v, [&](ZipEntry& e) { e.offset_error = far; }), f}, true));
  }
  for (const bool zip64 : {false, true}) {
    const std::string whole = zip({deflated, f}, zip64);
    for (std::size_t length = 0; length < whole.size(); ++length) {
      EXPECT_THROW((void)open_bytes(whole.substr(0, length)), Error) << length;
    }
  }
}

// Both its sizes reach into what follows, or beyond the end.
TEST(NpzHostile, AMemberEndsBeforeTheDirectory) {
  const std::string whole =
      zip({{.name = "V.npy", .content = positions(2, "(2, 4, 3)")}, {.name = "F.npy", .content = npy_bytes(kFaces)}});
  const std::size_t entry = whole.rfind("PK\x01\x02");  // of F.npy, the last member
  for (const std::uint32_t more : {1u, 100'000u}) {
    std::string damaged = whole;
    for (const std::size_t at : {entry + 20, entry + 24}) {
      std::string size;
      append(size, load<std::uint32_t>(whole.data() + at, std::endian::little) + more, std::endian::little);
      damaged.replace(at, size.size(), size);
    }
    expect_bad_npz("is not here; copy the file again", damaged);
  }
}

// Of a member that is not read as well: without its group, a body would be cloth.
TEST(NpzHostile, ANameInTheDirectoryIsThatBeforeTheMember) {
  const std::string whole = zip({{.name = "V.npy", .content = positions(2, "(2, 4, 3)")},
                                 {.name = "F.npy", .content = npy_bytes(kFaces)},
                                 {.name = "group.npy", .content = group_numbers({0, 1, 1})}});
  ASSERT_EQ(open_bytes(whole)->groups().size(), 2u);
  const std::size_t name = whole.rfind("group.npy");
  for (std::size_t bit = 0; bit < 8 * std::string("group.npy").size(); ++bit) {
    std::string damaged = whole;
    damaged[name + bit / 8] = static_cast<char>(damaged[name + bit / 8] ^ 1 << bit % 8);
    expect_bad_npz("is not here; copy the file again", damaged);
  }
}

TEST(NpzHostile, BombStopsAtTheSizeItShows) {
  const std::string zeros(50'000'000, '\0');
  const ZipEntry bomb = {.name = "V.npy", .content = zeros, .deflate = true, .size_error = 1000 - 50'000'000};
  expect_bad_npz("does not inflate to its size", zip({bomb, {.name = "F.npy", .content = npy_bytes(kFaces)}}));
}

TEST(NpzHostile, ArraysThatDoNotFit) {
  const auto archive = [](const std::string& v, const std::string& f, const std::string& group = "") {
    std::vector<ZipEntry> entries = {{.name = "V.npy", .content = v}, {.name = "F.npy", .content = f}};
    if (!group.empty()) entries.push_back({.name = "group.npy", .content = group});
    return zip(entries);
  };
  const std::string v = positions(2, "(2, 4, 3)"), f = npy_bytes(kFaces);
  expect_bad_npz("a.npz[V]: the shape does not fit", archive(positions(2, "(3, 4, 3)"), f));
  expect_bad_npz("a.npz[V]: the shape does not fit", archive(v + "x", f));
  expect_bad_npz("a.npz[V]: no vertices", archive(positions(0, "(1000000000000, 0, 3)"), f));
  expect_bad_npz("a.npz[V]: not floats in the shape", archive(positions(2, "(2, 3, 4)"), f));
  expect_bad_npz("a.npz[V]: not floats in the shape", archive(positions(2, "(24,)"), f));
  expect_bad_npz("a.npz[V]: not floats in the shape", archive(f, f));
  expect_bad_npz("a.npz[F]: faces are not integers", archive(v, npy_bytes(kFrame, Precision::kFloat64, "")));
  expect_bad_npz("a.npz[F]: face 1 names vertex 4 of 4", archive(v, npy_bytes(Triangles{{0, 1, 2}, {0, 2, 4}})));
  expect_bad_npz("a.npz[group]: 2 numbers for 3 faces", archive(v, f, group_numbers({0, 1})));
  expect_bad_npz("a.npz[group]: face 2 has the number 7", archive(v, f, group_numbers({0, 1, 7})));
  expect_bad_npz("a.npz[V]: in Fortran order", archive(positions(2, "(2, 4, 3)", true), f));
  std::string nan = v;
  nan.replace(nan.size() - 8, 8, std::string("\0\0\0\0\0\0\xf8\x7f", 8));
  const auto reader = open_bytes(archive(nan, f));
  EXPECT_EQ(reader->frame(0).points.size(), 4u);
  expect_error(ErrorKind::kBadInput, "a.npz[V]: frame 1: vertex 3 is not finite", [&] { (void)reader->frame(1); });
}

}  // namespace
}  // namespace selvage::io
