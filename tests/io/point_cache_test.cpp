#include "io/point_cache.h"

#include <gtest/gtest.h>

// gtest before RapidCheck's bridge
#include <bit>
#include <cmath>
#include <limits>

#include <rapidcheck/gtest.h>

#include "io/mesh_reader.h"
#include "io/sequence.h"
#include "io/sequence/sequence_readers.h"
#include "tests/io/parsers.h"
#include "tests/io/point_cache_builder.h"
#include "tests/io/support.h"
#include "tests/property.h"

namespace selvage::io {
namespace {

using testing::cache_value;
using testing::check_property;
using testing::expect_error;
using testing::spit;
using testing::TemporaryFolder;

const char* const kLeftAndRight = "o left\nv 9 9 9\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 1 1 0\no right\nf 3 2 4\n";

MeshData square() { return parse_obj(kLeftAndRight, "square"); }

void expect_frames(const SequenceReader& reader) {
  ASSERT_EQ(reader.frame_count(), 3u);
  EXPECT_EQ(reader.precision(), Precision::kFloat32);
  EXPECT_EQ(reader.kind(), SequenceKind::kFrames);
  EXPECT_EQ(reader.groups().size(), 2u);
  for (std::uint32_t frame = 0; frame < 3; ++frame) {
    const MeshData mesh = reader.frame(frame);
    EXPECT_EQ(mesh.triangles, square().triangles);
    EXPECT_EQ(mesh.groups, square().groups);
    EXPECT_TRUE(reader.same_faces_as_previous(frame));
    ASSERT_EQ(mesh.points.size(), 4u);
    for (std::uint32_t vertex = 0; vertex < 4; ++vertex) {
      for (std::uint32_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(mesh.points[vertex][axis], static_cast<double>(cache_value(frame, vertex, axis)));
      }
    }
  }
  EXPECT_THROW((void)reader.frame(3), std::out_of_range);
}

TEST(PointCache, Pc2IsReadWithTheMeshBesideIt) {
  const TemporaryFolder folder;
  spit(folder / "cloth.pc2", testing::pc2(4, 3));
  spit(folder / "cloth.obj", kLeftAndRight);
  const auto reader = open_sequence({folder / "cloth.pc2"});
  expect_frames(*reader);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(reader->time(i), 2.5 + 0.5 * static_cast<double>(i));
  EXPECT_FALSE(has_times(*reader)) << "it counts frames, whatever the start and the rate";
  EXPECT_EQ(reader->frame_name(2), (folder / "cloth.pc2").string() + "[2]");
}

TEST(PointCache, MddIsReadWithTheMeshThatIsNamed) {
  const TemporaryFolder folder;
  spit(folder / "run.MDD", testing::mdd(4, {-1, 0.04f, 7}));
  spit(folder / "other.obj", kLeftAndRight);
  const auto reader = open_sequence({folder / "run.MDD"}, folder / "other.obj");
  expect_frames(*reader);
  EXPECT_EQ(reader->time(0), -1);
  EXPECT_EQ(reader->time(1), static_cast<double>(0.04f));
  EXPECT_EQ(reader->time(2), 7);
}

TEST(PointCache, TheMeshMustBeThereAndFit) {
  const TemporaryFolder folder;
  spit(folder / "cloth.pc2", testing::pc2(4, 3));
  expect_error(ErrorKind::kBadInput, "cloth.pc2: has no faces, and no cloth.obj or .ply stands beside it",
               [&] { (void)open_sequence({folder / "cloth.pc2"}); });
  spit(folder / "cloth.ply", "ply\n");
  expect_error(ErrorKind::kBadInput, "cloth.ply:", [&] { (void)open_sequence({folder / "cloth.pc2"}); });
  spit(folder / "cloth.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_error(ErrorKind::kBadInput, "cloth.pc2: 4 vertices, the base mesh has 3",
               [&] { (void)open_sequence({folder / "cloth.pc2"}); });
  expect_error(ErrorKind::kFile, "none.obj: cannot open",
               [&] { (void)open_sequence({folder / "cloth.pc2"}, folder / "none.obj"); });
  expect_error(ErrorKind::kFile, "none.pc2: cannot open", [&] { (void)open_sequence({folder / "none.pc2"}); });
  expect_error(ErrorKind::kBadInput, "only a .pc2 or .mdd needs a base mesh",
               [&] { (void)open_sequence({folder / "cloth.obj"}, folder / "cloth.obj"); });
  expect_error(ErrorKind::kBadInput, "is a sequence by itself", [&] {
    (void)open_sequence({folder / "cloth.pc2", folder / "cloth.pc2"});
  });
}

/// Every float32 but NaN and infinity, subnormals and -0 included.
rc::Gen<float> finite_float() {
  return rc::gen::map(rc::gen::resize(100, rc::gen::arbitrary<std::uint32_t>()), [](std::uint32_t bits) {
    const auto value = std::bit_cast<float>(bits * 0x9e3779b9u);
    return std::isfinite(value) ? value : -std::numeric_limits<float>::denorm_min();
  });
}

TEST(PointCache, prop_every_float_becomes_the_double_that_it_is) {
  check_property(500, 1, [] {
    const auto values = *rc::gen::container<std::vector<float>>(12, finite_float());
    const bool big_endian = *rc::gen::arbitrary<bool>();
    std::string bytes = big_endian ? testing::mdd(4, {0}) : testing::pc2(4, 1);
    bytes.resize(big_endian ? 12 : 32);
    for (const float value : values) testing::append_bytes(bytes, value, big_endian);
    const auto format = big_endian ? PointCacheFormat::kMdd : PointCacheFormat::kPc2;
    const Points points = open_point_cache(in_memory(bytes), format, square(), "in")->frame(0).points;
    for (std::size_t i = 0; i < 12; ++i) {
      const double expected = static_cast<double>(values[i]);
      RC_ASSERT(std::bit_cast<std::uint64_t>(points[i / 3][i % 3]) == std::bit_cast<std::uint64_t>(expected));
    }
  });
}

TEST(PointCache, CutOrLengthenedAnywhereIsRefused) {
  for (const std::string name : {"pc2", "mdd"}) {
    for (const std::string& sound : testing::parser_named(name).sound_files) {
      for (std::size_t size = 0; size < sound.size(); ++size) {
        expect_error(ErrorKind::kBadInput, "in: byte " + std::to_string(size),
                     [&] { testing::parser_named(name).parse(sound.substr(0, size)); });
      }
      expect_error(ErrorKind::kBadInput, "in: byte " + std::to_string(sound.size()),
                   [&] { testing::parser_named(name).parse(sound + '\0'); });
    }
  }
}

/// A file of any size that is not there: remembers what is read of it.
class Watched final : public ByteSource {
 public:
  Watched(std::string start, std::uint64_t size) : start_(std::move(start)), size_(size) {}
  using ByteSource::read;
  std::uint64_t size() const override { return size_; }
  void read(std::uint64_t offset, char* bytes, std::size_t count) const override {
    total_read_ += count;
    last_offset_ = offset;
    for (std::size_t i = 0; i < count; ++i) bytes[i] = offset + i < start_.size() ? start_[offset + i] : '\0';
  }
  std::uint64_t total_read() const { return total_read_; }
  std::uint64_t last_offset() const { return last_offset_; }

 private:
  std::string start_;
  std::uint64_t size_;
  mutable std::uint64_t total_read_ = 0, last_offset_ = 0;
};

TEST(PointCache, OfTenGigabytesOnlyTheFrameAskedForIsRead) {
  constexpr std::uint32_t kFrames = 1000, kVertices = 1'000'000;
  constexpr std::uint64_t kFrameSize = 12ull * kVertices;
  MeshData base;
  base.points.resize(kVertices);
  base.triangles = {{0, 1, 2}};
  const auto source = std::make_shared<Watched>(testing::pc2(kVertices, 0, kFrames), 32 + kFrames * kFrameSize);
  const auto reader = open_point_cache(source, PointCacheFormat::kPc2, std::move(base), "in");
  EXPECT_LE(source->total_read(), 32u);
  EXPECT_EQ(reader->frame(999).points.size(), kVertices);
  EXPECT_EQ(source->last_offset(), 32 + 999 * kFrameSize);
  EXPECT_LE(source->total_read(), 32 + kFrameSize);
}

}  // namespace
}  // namespace selvage::io
