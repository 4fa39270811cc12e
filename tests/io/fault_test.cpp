// The system calls of the sequence writer, one after the other made to kill the process, to fail, or to write half. The
// functions below take the place of libc's in this program alone.
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/file/atomic_file.h"
#include "io/sequence.h"
#include "io/sequence_output.h"
#include "tests/io/support.h"

namespace {

enum class Fault { kNone, kKill, kKillHalfway, kFailOnce, kFailForever, kFailHalfway, kShortWrites, kInterruptions };

/// In the names of tests.
void PrintTo(Fault fault, std::ostream* out) {
  constexpr std::array kNames{"none",         "kill",         "kill halfway", "fail once",
                              "fail forever", "fail halfway", "short writes", "interruptions"};
  *out << kNames[static_cast<std::size_t>(fault)];
}

struct Plan {
  bool is_armed = false;
  Fault fault = Fault::kNone;
  int calls_before = 0;
  std::vector<std::string> log;
  bool lacks_no_replace = false, lacks_links = false;  ///< as some file systems do
} plan;

std::string name_of(int descriptor) {
  std::error_code status;
  return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), status).filename().string();
}

/// Counts a call and says whether the fault is due now.
bool is_due(const std::string& call) {
  if (!plan.is_armed) return false;
  plan.log.push_back(call);
  const bool can_fail = Fault::kKill <= plan.fault && plan.fault <= Fault::kFailHalfway;
  const bool is_due = can_fail && plan.calls_before-- <= 0;
  if (is_due && plan.fault == Fault::kKill) ::raise(SIGKILL);
  if (is_due && plan.fault != Fault::kFailForever) plan.is_armed = false;
  return is_due;
}

template <typename Function>
Function* original(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

int fail() {
  errno = ENOSPC;
  return -1;
}

/// As much of `count` as a call goes through with.
size_t share_of(size_t count) { return plan.is_armed && plan.fault == Fault::kShortWrites ? (count + 1) / 2 : count; }

/// Every second call of those that may be.
bool is_interrupted() {
  if (!plan.is_armed || plan.fault != Fault::kInterruptions || plan.calls_before++ % 2 != 0) return false;
  errno = EINTR;
  return true;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  const bool creates = (flags & O_CREAT) != 0;
  if (creates && is_due("create " + std::filesystem::path(path).stem().string())) return fail();
  return original<int(const char*, int, ...)>("open")(path, flags, mode);
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  auto* const write_all = original<ssize_t(int, const void*, size_t)>("write");
  if (is_interrupted()) return -1;
  if (!is_due("write " + name_of(descriptor))) return write_all(descriptor, bytes, share_of(count));
  if (plan.fault == Fault::kKillHalfway || plan.fault == Fault::kFailHalfway) {
    if (write_all(descriptor, bytes, count / 2) < 0) ::abort();
    if (plan.fault == Fault::kKillHalfway) ::raise(SIGKILL);
  }
  return fail();
}

ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t offset) {
  if (is_interrupted()) return -1;
  if (is_due("overwrite " + name_of(descriptor))) return fail();
  return original<ssize_t(int, const void*, size_t, off_t)>("pwrite")(descriptor, bytes, share_of(count), offset);
}

ssize_t read(int descriptor, void* bytes, size_t count) {
  if (is_interrupted()) return -1;
  return original<ssize_t(int, void*, size_t)>("read")(descriptor, bytes, share_of(count));
}

ssize_t pread(int descriptor, void* bytes, size_t count, off_t offset) {
  if (is_interrupted()) return -1;
  return original<ssize_t(int, void*, size_t, off_t)>("pread")(descriptor, bytes, share_of(count), offset);
}

/// A kill does not lose what is in the system's memory, so that the disk need not be waited for.
int fsync(int descriptor) { return is_due("sync " + name_of(descriptor)) ? fail() : 0; }

int rename(const char* from, const char* to) noexcept {
  if (is_due("rename " + std::filesystem::path(to).filename().string())) return fail();
  return original<int(const char*, const char*)>("rename")(from, to);
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  if (plan.lacks_no_replace) {
    errno = EINVAL;
    return -1;
  }
  if (is_due("rename " + std::filesystem::path(to).filename().string())) return fail();
  return original<int(int, const char*, int, const char*, unsigned)>("renameat2")(from_folder, from, to_folder, to,
                                                                                  flags);
}

int link(const char* from, const char* to) noexcept {
  if (plan.lacks_links) {
    errno = EPERM;
    return -1;
  }
  return original<int(const char*, const char*)>("link")(from, to);
}

}  // extern "C"

namespace selvage::io {
namespace {

using testing::same_bits;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

constexpr std::size_t kFrames = 3;
const SequenceHeader kHeader = {.triangles = {{0, 1, 2}}, .groups = {}, .producer = "test"};

Points points_of(std::size_t frame) {
  const auto x = static_cast<double>(frame);
  return {{x, 0, 0}, {1, x, 0}, {0, 1, x}};
}

/// Creates or resumes, and appends until kFrames are there; counts what was acknowledged.
void run(const std::filesystem::path& folder, std::size_t& acknowledged) {
  SequenceWriter writer(folder, kHeader, true);
  acknowledged = writer.frame_count();
  while (acknowledged < kFrames) {
    writer.append(static_cast<double>(acknowledged), points_of(acknowledged));
    ++acknowledged;
  }
}

/// Listed frames are whole, and at least `acknowledged`. Returns their number.
std::size_t expect_sound(const std::filesystem::path& folder, std::size_t acknowledged) {
  if (!std::filesystem::exists(folder / "sequence.json")) {
    EXPECT_EQ(acknowledged, 0u);
    return 0;
  }
  const auto reader = open_sequence({folder});
  EXPECT_GE(reader->frame_count(), acknowledged);
  for (std::size_t i = 0; i < reader->frame_count(); ++i) EXPECT_TRUE(same_bits(reader->frame(i).points, points_of(i)));
  return reader->frame_count();
}

void expect_finished(const std::filesystem::path& folder) {
  std::size_t acknowledged = 0;
  run(folder, acknowledged);
  EXPECT_EQ(expect_sound(folder, kFrames), kFrames);
  const auto files = std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  EXPECT_EQ(files, 3 + static_cast<std::ptrdiff_t>(kFrames)) << "something is left behind";
}

class EveryCall : public ::testing::TestWithParam<Fault> {};

TEST_P(EveryCall, MayFailOrBeTheLast) {
  const bool kills = GetParam() == Fault::kKill || GetParam() == Fault::kKillHalfway;
  int calls = 0;
  for (bool was_hit = true; was_hit; ++calls) {
    ASSERT_LT(calls, 1000) << "the fault never ends";
    SCOPED_TRACE(calls);
    const TemporaryFolder folder;
    std::size_t acknowledged = 0;
    if (kills) {
      const pid_t child = ::fork();
      if (child == 0) {
        plan = {.is_armed = true, .fault = GetParam(), .calls_before = calls, .log = {}};
        try {
          run(folder.path(), acknowledged);
        } catch (const Error&) {
          ::_exit(1);  // halfway is not possible in this call: it fails instead
        }
        ::_exit(0);
      }
      int status = 0;
      ASSERT_EQ(::waitpid(child, &status, 0), child);
      was_hit = WIFSIGNALED(status) || WEXITSTATUS(status) != 0;
    } else {
      plan = {.is_armed = true, .fault = GetParam(), .calls_before = calls, .log = {}};
      was_hit = false;
      try {
        run(folder.path(), acknowledged);
      } catch (const Error& error) {
        was_hit = true;
        EXPECT_EQ(error.kind(), ErrorKind::kFile) << error.what();
        EXPECT_NE(std::string(error.what()).find("No space left on device; free some space"), std::string::npos);
      }
    }
    plan = {};
    expect_sound(folder.path(), acknowledged);
    expect_finished(folder.path());
  }
  EXPECT_GT(calls, 30) << "the calls are not seen";
}

INSTANTIATE_TEST_SUITE_P(All, EveryCall,
                         ::testing::Values(Fault::kKill, Fault::kKillHalfway, Fault::kFailOnce, Fault::kFailForever,
                                           Fault::kFailHalfway));

TEST(WriterFaults, TheSameWriterGoesOnAfterAFailure) {
  for (int calls = 0; calls < 7; ++calls) {  // an append makes seven calls, as the next test says
    SCOPED_TRACE(calls);
    const TemporaryFolder folder;
    SequenceWriter writer(folder.path(), kHeader);
    writer.append(0, points_of(0));
    plan = {.is_armed = true, .fault = Fault::kFailHalfway, .calls_before = calls, .log = {}};
    EXPECT_THROW(writer.append(1, points_of(1)), Error);
    plan = {};
    EXPECT_EQ(writer.frame_count(), 1u);
    writer.append(1, points_of(1));
    EXPECT_EQ(expect_sound(folder.path(), 2), 2u);
  }
}

TEST(WriterFaults, ShortAndInterruptedWritesAreContinued) {
  for (const Fault fault : {Fault::kShortWrites, Fault::kInterruptions}) {
    const TemporaryFolder folder;
    plan = {.is_armed = true, .fault = fault, .calls_before = 0, .log = {}};
    std::size_t acknowledged = 0;
    EXPECT_NO_THROW(run(folder.path(), acknowledged));
    plan = {};
    EXPECT_EQ(expect_sound(folder.path(), acknowledged), kFrames);
  }
}

TEST(WriterFaults, EverythingIsSyncedBeforeTheNextDependsOnIt) {
  const TemporaryFolder folder;
  SequenceWriter writer(folder.path(), kHeader);
  plan = {.is_armed = true, .fault = Fault::kNone, .calls_before = 0, .log = {}};
  writer.append(0, points_of(0));
  std::vector<std::string> log = plan.log;
  plan = {};
  for (std::string& call : log) {
    if (const std::size_t mark = call.find(".tmp-"); mark != call.npos) call.resize(mark + 4);
  }
  const std::vector<std::string> expected = {"create frame_000000.npy",
                                             "write frame_000000.npy.tmp",
                                             "sync frame_000000.npy.tmp",
                                             "rename frame_000000.npy",
                                             "sync " + folder.path().filename().string(),
                                             "write frames.jsonl",
                                             "sync frames.jsonl"};
  EXPECT_EQ(log, expected);
}

TEST(AtomicFileFaults, TheOldFileStaysWhateverCallFails) {
  for (const Fault fault : {Fault::kFailOnce, Fault::kFailHalfway}) {
    for (int calls = 0; calls < 4; ++calls) {  // create, write, sync, rename; then the new file is in place
      const TemporaryFolder folder;
      spit(folder / "a", "old");
      plan = {.is_armed = true, .fault = fault, .calls_before = calls, .log = {}};
      EXPECT_THROW(write_atomically(folder / "a", "new content"), Error);
      plan = {};
      EXPECT_EQ(slurp(folder / "a"), "old");
      EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "a temporary file is left";
    }
  }
}

TEST(AtomicFileFaults, ANewFileTakesNoPlaceOnAnyFileSystem) {
  for (const bool lacks_links : {false, true}) {
    const TemporaryFolder folder;
    plan.lacks_no_replace = true;
    plan.lacks_links = lacks_links;
    const auto commit = [&](const char* name) {
      AtomicFile file(folder / name);
      file.write("new");
      file.commit_new();
    };
    EXPECT_NO_THROW(commit("a"));
    spit(folder / "b", "theirs");
    EXPECT_THROW(commit("b"), Error);
    plan = {};
    EXPECT_EQ(slurp(folder / "a"), "new");
    EXPECT_EQ(slurp(folder / "b"), "theirs");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2) << "a temporary file is left";
  }
}

class EveryCallOfAnOutput : public ::testing::TestWithParam<std::tuple<std::string, Fault>> {};

void convert(const std::filesystem::path& target) {
  const auto output = create_output(target, {kHeader, 3, kFrames});
  for (std::size_t i = 0; i < kFrames; ++i) {
    output->append(static_cast<double>(i), {points_of(i), kHeader.triangles, {}, Precision::kFloat64});
  }
  output->finish();
}

/// Name and bytes of all files below a folder but temporary ones.
std::map<std::string, std::string> files_below(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && !is_temporary_name(name)) files[name] = slurp(entry.path());
  }
  return files;
}

TEST_P(EveryCallOfAnOutput, LeavesNothingOrWholeFiles) {
  const auto& [name, fault] = GetParam();
  const TemporaryFolder sound;
  convert(sound / name);
  const std::map<std::string, std::string> expected = files_below(sound.path());
  int calls = 0;
  for (bool was_hit = true; was_hit; ++calls) {
    ASSERT_LT(calls, 1000) << "the fault never ends";
    SCOPED_TRACE(calls);
    const TemporaryFolder folder;
    const pid_t child = ::fork();
    if (child == 0) {
      plan = {.is_armed = true, .fault = fault, .calls_before = calls, .log = {}};
      try {
        convert(folder / name);
      } catch (const Error&) {
        ::_exit(1);
      }
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    was_hit = WIFSIGNALED(status) || WEXITSTATUS(status) != 0;
    const std::map<std::string, std::string> files = files_below(folder.path());
    if (!was_hit) {
      EXPECT_EQ(files, expected);
    } else if (WIFSIGNALED(status)) {
      for (const auto& [file, bytes] : files) {
        if (file == "frames.jsonl" && !files.contains("sequence.json")) continue;  // shorter, and no sequence
        EXPECT_EQ(bytes, expected.at(file)) << file << " is not whole";
      }
    } else {
      EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 0) << "something is left behind";
    }
  }
  EXPECT_GT(calls, 8) << "the calls are not seen";
}

// Of an .npz sizes are written into what stands before the data, and a frame is read where it is in the file.
TEST(OutputFaults, ShortAndInterruptedCallsAreContinued) {
  for (const Fault fault : {Fault::kShortWrites, Fault::kInterruptions}) {
    for (const char* name : {"a.npz", "a.obj", "a.pc2", "folder"}) {
      const TemporaryFolder sound, folder;
      convert(sound / name);
      plan = {.is_armed = true, .fault = fault, .calls_before = 0, .log = {}};
      EXPECT_NO_THROW(convert(folder / name)) << name;
      plan = {};
      EXPECT_EQ(files_below(folder.path()), files_below(sound.path())) << name;
      if (!std::filesystem::exists(folder / name)) continue;  // a file a frame
      plan = {.is_armed = true, .fault = fault, .calls_before = 0, .log = {}};
      for (std::size_t i = 0; i < kFrames; ++i) {
        EXPECT_TRUE(same_bits(open_sequence({folder / name})->frame(i).points, points_of(i))) << name;
      }
      plan = {};
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryCallOfAnOutput,
                         ::testing::Combine(::testing::Values("a.npz", "a.obj", "a.pc2", "a.pvd", "folder"),
                                            ::testing::Values(Fault::kKill, Fault::kKillHalfway, Fault::kFailOnce,
                                                              Fault::kFailHalfway)));

}  // namespace
}  // namespace selvage::io
