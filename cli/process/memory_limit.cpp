#include "cli/process/memory_limit.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include <sys/resource.h>

namespace selvage::cli {
namespace {

constexpr std::uint64_t kBytesPerKB = 1024;

/// Of a line "KEY:   NUMBER kB".
std::optional<std::uint64_t> bytes_of(std::istream& lines, const std::string& key) {
  lines.clear();
  lines.seekg(0);
  for (std::string word; lines >> word;) {
    std::uint64_t kilobytes = 0;
    if (word == key + ":" && lines >> kilobytes) return kilobytes * kBytesPerKB;
    lines.clear();
    lines.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return {};
}

}  // namespace

std::optional<std::uint64_t> usable_memory(std::istream& meminfo, std::istream& group_limit) {
  const auto total = bytes_of(meminfo, "MemTotal"), available = bytes_of(meminfo, "MemAvailable");
  if (!total || !available) return {};
  std::uint64_t usable = std::max(*available, *total / 2) + bytes_of(meminfo, "SwapFree").value_or(0);
  if (std::uint64_t limit = 0; group_limit >> limit) usable = std::min(usable, limit);  // "max": there is none
  return usable;
}

void make_lack_of_memory_an_error() {
  std::ifstream meminfo("/proc/meminfo"), group_limit("/sys/fs/cgroup/memory.max"), status("/proc/self/status");
  const auto usable = usable_memory(meminfo, group_limit), used = bytes_of(status, "VmData");
  rlimit limit{};
  if (!usable || !used || ::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  // What is mapped already, as by a sanitizer, comes on top.
  limit.rlim_cur = std::min<std::uint64_t>(limit.rlim_cur, *used + *usable);
  (void)::setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace selvage::cli
