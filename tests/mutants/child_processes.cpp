#include "tests/mutants/child_processes.h"

#include <csignal>
#include <ctime>
#include <map>
#include <stdexcept>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace selvage::mutants {
namespace {

/// The slowest work takes a tenth of the processor time; the other limit is for what waits for ever.
constexpr rlim_t kProcessorLimitS = 300;
constexpr unsigned kWallLimitS = 3600;

[[noreturn]] void run_child(const std::function<std::string()>& work, int out) {
  const rlimit limit{kProcessorLimitS, kProcessorLimitS + 1};
  setrlimit(RLIMIT_CPU, &limit);
  alarm(kWallLimitS);
  const std::string result = work();
  const std::string text = std::to_string(static_cast<double>(std::clock()) / CLOCKS_PER_SEC) + " " + result;
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(out, text.data() + done, text.size() - done);
    if (count <= 0) _exit(1);
    done += static_cast<std::size_t>(count);
  }
  _exit(0);
}

struct Child {
  std::size_t index = 0;
  int in = -1;
};

void start(const std::function<std::string()>& work, std::size_t index, std::map<pid_t, Child>& children) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("no process");
  if (pid == 0) {
    close(ends[0]);
    run_child(work, ends[1]);
  }
  close(ends[1]);
  children[pid] = {index, ends[0]};
}

std::string read_all(int in) {
  std::string text;
  char buffer[4096];
  for (ssize_t count; (count = read(in, buffer, sizeof buffer)) > 0;) {
    text.append(buffer, static_cast<std::size_t>(count));
  }
  close(in);
  return text;
}

ChildResult result_of(int status, const std::string& text) {
  ChildResult result;
  const bool is_late = WIFSIGNALED(status) && (WTERMSIG(status) == SIGALRM || WTERMSIG(status) == SIGXCPU);
  if (is_late) result.end = ChildEnd::kTimeout;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return result;
  std::size_t end = 0;
  result.seconds = std::stod(text, &end);
  result.text = text.substr(end + 1);
  result.end = ChildEnd::kDone;
  return result;
}

}  // namespace

std::vector<ChildResult> run_children(const std::vector<std::function<std::string()>>& work, int jobs,
                                      const std::function<void(std::size_t, const ChildResult&)>& on_end) {
  std::vector<ChildResult> results(work.size());
  std::map<pid_t, Child> children;
  for (std::size_t next = 0; next < work.size() || !children.empty();) {
    if (next < work.size() && children.size() < static_cast<std::size_t>(jobs)) {
      start(work[next], next, children);
      ++next;
      continue;
    }
    int status = 0;
    const auto ended = children.find(wait(&status));
    if (ended == children.end()) throw std::runtime_error("lost a process");
    const Child child = ended->second;
    children.erase(ended);
    results[child.index] = result_of(status, read_all(child.in));
    on_end(child.index, results[child.index]);
  }
  return results;
}

}  // namespace selvage::mutants
