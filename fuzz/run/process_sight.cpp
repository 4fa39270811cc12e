#include "fuzz/run/process_sight.h"

#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace selvage::fuzz {

std::optional<double> processor_seconds(pid_t process) {
  clockid_t clock{};
  timespec now{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &now) != 0) return std::nullopt;
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

bool is_asleep(pid_t process) {
  std::error_code error;  // of threads that end while we look
  std::filesystem::directory_iterator thread("/proc/" + std::to_string(process) + "/task", error);
  for (; !error && thread != end(thread); thread.increment(error)) {
    std::ifstream file(thread->path() / "stat");
    std::string stat;
    std::getline(file, stat);
    const std::size_t state = stat.rfind(')') + 2;  // behind the program's name, which may hold anything
    if (state >= stat.size() || (stat[state] != 'S' && stat[state] != 'T')) return false;
  }
  return !error;
}

}  // namespace selvage::fuzz
