// SIGKILL at any moment: what was acknowledged is there, what is listed is whole, and a resumed run ends in the same
// bytes as one that was never killed.
#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/sequence.h"
#include "tests/io/support.h"

namespace selvage::io {
namespace {

using testing::same_bits;
using testing::slurp;
using testing::TemporaryFolder;

const SequenceHeader kHeader = {.triangles = {{0, 1, 2}}, .groups = {}, .producer = "test"};

/// 2,000 vertices, so that a write is long enough to be hit.
Points points_of(std::size_t frame) {
  Points points(2'000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto x = static_cast<double>(frame * points.size() + i);
    points[i] = {x, 0.1 * x, -x};
  }
  return points;
}

/// Appends until it is killed; sends one byte through `acknowledge` behind each frame.
[[noreturn]] void run_forever(const std::filesystem::path& folder, int acknowledge) {
  try {
    SequenceWriter writer(folder, kHeader, true);
    for (;;) {
      const std::size_t frame = writer.frame_count();
      writer.append(static_cast<double>(frame), points_of(frame));
      if (::write(acknowledge, "!", 1) != 1) ::_exit(3);
    }
  } catch (const Error&) {
    ::_exit(4);
  }
}

/// Lets a run live for `frames` acknowledged frames and `more` of a frame's time, then kills it. Returns the number of
/// frames acknowledged. The disk sets the pace, so that kills fall into all phases of a frame on any machine.
std::size_t run_and_kill(const std::filesystem::path& folder, std::size_t frames, double more) {
  using Clock = std::chrono::steady_clock;
  int channel[2] = {};
  EXPECT_EQ(::pipe(channel), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(channel[0]);
    run_forever(folder, channel[1]);
  }
  ::close(channel[1]);
  std::size_t acknowledged = 0;
  char byte = 0;
  const Clock::time_point start = Clock::now();
  while (acknowledged < frames && ::read(channel[0], &byte, 1) == 1) ++acknowledged;
  const auto frame_time = (Clock::now() - start) / static_cast<double>(std::max<std::size_t>(frames, 1));
  std::this_thread::sleep_for(frames == 0 ? std::chrono::duration<double, std::nano>(2e6 * more) : more * frame_time);
  ::kill(child, SIGKILL);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the writer failed by itself: " << status;
  while (::read(channel[0], &byte, 1) == 1) ++acknowledged;
  ::close(channel[0]);
  return acknowledged;
}

TEST(SequenceWriterKilled, NothingAcknowledgedIsLostNothingListedIsTorn) {
  const TemporaryFolder folder, undisturbed;
  std::mt19937 random(1);
  std::size_t known = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const double more = static_cast<double>(random() % 1000) / 500;
    known += run_and_kill(folder.path(), random() % 3, more);
    if (!std::filesystem::exists(folder / "sequence.json")) {
      ASSERT_EQ(known, 0u);
      continue;
    }
    const auto reader = open_sequence({folder.path()});
    ASSERT_GE(reader->frame_count(), known) << "an acknowledged frame is lost";
    ASSERT_LE(reader->frame_count(), known + 1) << "a frame was listed and the next begun before it was acknowledged";
    known = reader->frame_count();
    for (std::size_t i = 0; i < known; ++i) ASSERT_TRUE(same_bits(reader->frame(i).points, points_of(i))) << i;
  }
  EXPECT_GT(known, 0u) << "no run lived long enough to test anything";

  const std::size_t last = known + 1;
  SequenceWriter resumed(folder.path(), kHeader, true), whole(undisturbed.path(), kHeader);
  for (std::size_t i = 0; i < last; ++i) {
    whole.append(static_cast<double>(i), points_of(i));
    if (i >= known) resumed.append(static_cast<double>(i), points_of(i));
  }
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(undisturbed.path())) {
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(slurp(folder / name), slurp(undisturbed / name)) << name;
    ++files;
  }
  const auto in_folder = std::distance(std::filesystem::directory_iterator(folder.path()), {});
  EXPECT_EQ(static_cast<std::size_t>(in_folder), files) << "killed runs leave files behind";
}

}  // namespace
}  // namespace selvage::io
