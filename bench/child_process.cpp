#include "bench/child_process.h"

#include <filesystem>
#include <stdexcept>
#include <system_error>

#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace selvage::bench {
namespace {

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

void write_all(int file, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(file, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) fail("write");
    if (count > 0) done += static_cast<std::size_t>(count);
  }
}

std::string read_all(int file) {
  std::string bytes, part(1 << 16, '\0');
  for (;;) {
    const ssize_t count = ::read(file, part.data(), part.size());
    if (count == 0) return bytes;
    if (count < 0 && errno != EINTR) fail("read");
    if (count > 0) bytes.append(part, 0, static_cast<std::size_t>(count));
  }
}

/// The first byte says whether it is an answer or the message of an exception. Leaves without destructors and exit
/// handlers: they are the parent's.
[[noreturn]] void be_child(int out, const std::function<std::string()>& body) {
  int status = 1;
  try {
    std::string answer;
    try {
      answer = '+' + body();
    } catch (const std::exception& error) {
      answer = std::string("-") + error.what();
    }
    write_all(out, answer);
    status = 0;
  } catch (...) {
    // the parent sees the status
  }
  ::_exit(status);
}

}  // namespace

ChildOutcome run_in_child(const std::function<std::string()>& body) {
  const std::filesystem::directory_iterator threads("/proc/self/task");
  if (std::distance(begin(threads), end(threads)) != 1)
    throw std::logic_error("run_in_child: this process has threads");
  ::malloc_trim(0);  // memory that was freed here would hide as much of the child's
  int ends[2];
  if (::pipe(ends) != 0) fail("pipe");
  const pid_t child = ::fork();
  if (child < 0) fail("fork");
  if (child == 0) {
    ::close(ends[0]);
    be_child(ends[1], body);
  }
  ::close(ends[1]);
  ChildOutcome outcome{read_all(ends[0]), 0};
  ::close(ends[0]);
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, 0, &usage) < 0) {
    if (errno != EINTR) fail("wait4");
  }
  if (status != 0 || outcome.answer.empty()) throw std::runtime_error("a child of the benchmark died");
  if (outcome.answer.front() == '-') throw std::runtime_error(outcome.answer.substr(1));
  outcome.answer.erase(0, 1);
  outcome.peak_bytes = std::int64_t{usage.ru_maxrss} * 1024;
  return outcome;
}

}  // namespace selvage::bench
