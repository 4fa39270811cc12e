// NumPy reads what is written, by the example of docs/formats.md, and what NumPy writes is read.
#include <cstdlib>
#include <optional>

#include <gtest/gtest.h>

#include "io/sequence.h"
#include "tests/io/support.h"

namespace selvage::io {
namespace {

using testing::same_bits;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

/// A Python that has NumPy; distributions may have several interpreters.
std::optional<std::string> python_with_numpy() {
  for (const std::string python : {"python3", "/usr/bin/python3"}) {
    if (std::system((python + " -c 'import numpy' 2>/dev/null").c_str()) == 0) return python;
  }
  return std::nullopt;
}

/// The first Python example of the page.
std::string documented_example() {
  const std::string page = slurp(SELVAGE_SOURCE_DIR "/docs/formats.md");
  const std::string fence = "```python\n";
  const std::size_t begin = page.find(fence);
  return begin == page.npos ? "" : page.substr(begin + fence.size(), page.find("```\n", begin) - begin - fence.size());
}

const char* const kConversions = R"(
import zlib
for frame in frames:
    assert zlib.crc32(open("run/" + frame["file"], "rb").read()) == int(frame["crc32"], 16)
assert V.dtype == np.float64 and V.shape == (3, 4, 3) and F.dtype == np.int32
group = np.array([0, 1], dtype=np.int64)
np.savez("stored.npz", V=V, F=F, group=group)
np.savez_compressed("deflated.npz", V=V.astype(">f8"), F=F.astype(np.uint64), group=group.astype(np.uint8))
np.savez("one.npz", V=np.asfortranarray(V[2]), F=np.asfortranarray(F))
)";

TEST(NumPy, ReadsAndWritesTheSameBits) {
  const std::optional<std::string> python = python_with_numpy();
  if (!python) GTEST_SKIP() << "no Python with NumPy";
  const TemporaryFolder folder;
  const Triangles triangles = {{0, 1, 2}, {2, 3, 0}};
  std::vector<Points> frames;
  {
    SequenceWriter writer(folder / "run", {.triangles = triangles, .groups = {}, .producer = "test"});
    for (int i = 0; i < 3; ++i) {
      frames.push_back({{0.1 * i, -0.0, 0x1p-1074}, {1e300, 2, 3}, {0.3, 1.0 / 3, 7}, {1, 1, 1}});
      writer.append(0.1 * i, frames.back());
    }
  }
  const std::string example = documented_example();
  ASSERT_NE(example, "");
  spit(folder / "script.py", example + kConversions);
  ASSERT_EQ(std::system(("cd '" + folder.path().string() + "' && " + *python + " script.py").c_str()), 0);

  const std::vector<Group> groups = {{"cloth", Group::Role::kCloth, 0, 1}, {"body", Group::Role::kBody, 1, 2}};
  for (const char* name : {"stored.npz", "deflated.npz"}) {
    const auto reader = open_sequence({folder / name});
    ASSERT_EQ(reader->frame_count(), 3u) << name;
    EXPECT_EQ(reader->groups(), groups) << name;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(same_bits(reader->frame(i).points, frames[i])) << name;
      EXPECT_EQ(reader->frame(i).triangles, triangles) << name;
    }
  }
  const auto one = open_sequence({folder / "one.npz"});
  ASSERT_EQ(one->frame_count(), 1u);
  EXPECT_TRUE(same_bits(one->frame(0).points, frames[2]));
  EXPECT_EQ(one->frame(0).triangles, triangles);
}

}  // namespace
}  // namespace selvage::io
