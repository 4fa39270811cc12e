#include "io/file/atomic_file.h"

#include <functional>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/byte_source.h"
#include "tests/io/support.h"

namespace selvage::io {
namespace {

namespace fs = std::filesystem;
using testing::expect_error;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

std::size_t entries(const TemporaryFolder& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
}

TEST(AtomicFile, BytesComeBack) {
  const TemporaryFolder folder;
  std::string bytes;
  for (int i = 0; i < 300'000; ++i) bytes += static_cast<char>(i * 7 + i / 256);
  write_atomically(folder / "a", bytes);
  EXPECT_EQ(read_file(folder / "a"), bytes);
  write_atomically(folder / "a", "");
  EXPECT_EQ(read_file(folder / "a"), "");
  EXPECT_EQ(entries(folder), 1u) << "a temporary file is left";
}

TEST(AtomicFile, ANewFileTakesNoPlace) {
  const TemporaryFolder folder;
  const auto commit = [&](const char* name, const std::function<void()>& meanwhile) {
    AtomicFile file(folder / name);
    file.write("new");
    meanwhile();
    file.commit_new();
  };
  commit("a", [] {});
  EXPECT_EQ(slurp(folder / "a"), "new");
  expect_error(ErrorKind::kFile, "b: is there already; remove it, or choose another name",
               [&] { commit("b", [&] { spit(folder / "b", "theirs"); }); });
  EXPECT_EQ(slurp(folder / "b"), "theirs");
  expect_error(ErrorKind::kFile, "is there already",
               [&] { commit("c", [&] { fs::create_symlink("nothing", folder / "c"); }); });
  EXPECT_TRUE(fs::is_symlink(folder / "c"));
  EXPECT_EQ(entries(folder), 3u) << "a temporary file is left";
}

TEST(AtomicFile, LinkIsFollowed) {
  const TemporaryFolder folder;
  spit(folder / "target", "old");
  fs::create_symlink(folder / "target", folder / "link");
  write_atomically(folder / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(slurp(folder / "target"), "new");
}

TEST(AtomicFile, FailureLeavesTheOldFile) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::kFile, "No such file", [&] { write_atomically(folder / "missing/a", "x"); });
  // The folder "taken" is in the way of the rename.
  fs::create_directories(folder / "taken/inside");
  expect_error(ErrorKind::kFile, "taken", [&] { write_atomically(folder / "taken", "x"); });
  EXPECT_TRUE(fs::is_directory(folder / "taken/inside"));
  EXPECT_EQ(entries(folder), 1u) << "a temporary file is left";
}

/// Runs `action` in a child that is not root: root may write everywhere.
void run_as_nobody(const std::function<void()>& action) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    if (::geteuid() == 0 && ::setuid(kNobody) != 0) ::_exit(2);
    action();
    ::_exit(::testing::Test::HasFailure() ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

TEST(AtomicFile, UnwritableFolderLeavesTheOldFile) {
  const TemporaryFolder folder;
  spit(folder / "a", "old");
  fs::permissions(folder / "a", fs::perms::all);
  fs::permissions(folder.path(),
                  fs::perms::others_read | fs::perms::others_exec | fs::perms::owner_read | fs::perms::owner_exec);
  run_as_nobody([&] {
    for (const char* name : {"a", "b"}) {  // whoever may write the file, or it is not there yet
      const std::string words = (folder / name).string() +
                                ": cannot write in its folder: Permission denied; check the permissions of " +
                                folder.path().string() + ", where a new file is written first";
      expect_error(ErrorKind::kFile, words.c_str(), [&] { write_atomically(folder / name, "new"); });
    }
  });
  fs::permissions(folder.path(), fs::perms::owner_all);
  EXPECT_EQ(slurp(folder / "a"), "old");
}

TEST(AtomicFile, WhatIsReplacedKeepsItsPermissions) {
  const TemporaryFolder folder;
  spit(folder / "a", "old");
  fs::permissions(folder / "a", fs::perms::owner_read | fs::perms::owner_write);
  write_atomically(folder / "a", "new");
  EXPECT_EQ(slurp(folder / "a"), "new");
  EXPECT_EQ(fs::status(folder / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(AtomicFile, FullDeviceIsAnErrorAndTheDeviceStays) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  expect_error(ErrorKind::kFile, "No space left", [] { write_atomically("/dev/full", "x"); });
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(AtomicFile, ReadRefusesWhatHasNoEnd) {
  const TemporaryFolder folder;
  spit(folder / "a", "12345");
  EXPECT_EQ(read_file(folder / "a", 5), "12345");
  expect_error(ErrorKind::kBadInput, "larger than 4", [&] { (void)read_file(folder / "a", 4); });
  expect_error(ErrorKind::kFile, "directory", [&] { (void)read_file(folder.path()); });
  expect_error(ErrorKind::kFile, "device", [] { (void)read_file("/dev/zero"); });
  expect_error(ErrorKind::kFile, "No such file", [&] { (void)read_file(folder / "b"); });
}

// Files of the kernel say that they are empty, and a file may grow while it is read.
TEST(AtomicFile, ReadGoesOnBehindTheSizeThatAFileHas) {
  const fs::path file = "/proc/self/mountinfo";
  if (!fs::exists(file)) GTEST_SKIP() << "no /proc";
  ASSERT_EQ(fs::file_size(file), 0u);
  EXPECT_EQ(read_file(file), slurp(file));
}

TEST(AtomicFile, APipeIsRefusedAndNotWaitedFor) {
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ::alarm(20);  // a reader that waits for the other end is ended here
  expect_error(ErrorKind::kFile, "pipe: a pipe or a device, not a file; write it to a file first, and name that",
               [&] { (void)read_file(pipe); });
  expect_error(ErrorKind::kFile, "write it to a file first", [&] { (void)open_file(pipe); });
  expect_error(ErrorKind::kFile, "write it to a file first", [] { (void)open_file("/dev/zero"); });
  expect_error(ErrorKind::kFile, "directory", [&] { (void)open_file(folder.path()); });
  ::alarm(0);
}

TEST(AtomicFile, APipeIsWrittenInPlace) {
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string bytes(200'000, 'p');
  std::thread writer([&] { write_atomically(pipe, bytes); });
  EXPECT_EQ(slurp(pipe), bytes);
  writer.join();
}

TEST(AtomicFile, TheLongestNameCanBeWritten) {
  const TemporaryFolder folder;
  const std::string longest(255, 'n'), other = std::string(254, 'n') + "o";
  write_atomically(folder / longest, "1");
  write_atomically(folder / other, "2");
  EXPECT_EQ(read_file(folder / longest) + read_file(folder / other), "12");
  EXPECT_EQ(entries(folder), 2u) << "a temporary file is left";
}

TEST(AtomicFile, TemporaryNamesAreKnown) {
  EXPECT_TRUE(is_temporary_name("frame_000000.npy.tmp-123"));
  EXPECT_FALSE(is_temporary_name("frame_000000.npy"));
  EXPECT_FALSE(is_temporary_name("frame.tmp-"));
  EXPECT_FALSE(is_temporary_name("frame.tmp-12a"));
  EXPECT_FALSE(is_temporary_name(".tmp-12"));
}

}  // namespace
}  // namespace selvage::io
