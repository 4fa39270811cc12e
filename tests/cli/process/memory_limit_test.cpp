#include "cli/process/memory_limit.h"

#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace selvage::cli {
namespace {

constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;

std::optional<std::uint64_t> usable(const std::string& meminfo, const std::string& group_limit) {
  std::istringstream of_machine(meminfo), of_group(group_limit);
  return usable_memory(of_machine, of_group);
}

// 16 GiB, of which `available_kB` are; 2 of swap, of which one is free.
std::string meminfo(const std::string& available_kB) {
  return "MemTotal:       16777216 kB\nMemFree:           12345 kB\nMemAvailable:   " + available_kB +
         " kB\nSwapCached:            7 kB\nSwapTotal:       2097152 kB\nSwapFree:        1048576 kB\n";
}

}  // namespace

TEST(MemoryLimit, IsWhatIsFreeWithSwap) { EXPECT_EQ(usable(meminfo("12582912"), ""), 13 * kGiB); }

TEST(MemoryLimit, IsHalfOfTheMemoryWhereOthersHoldMore) { EXPECT_EQ(usable(meminfo("1048576"), "max\n"), 9 * kGiB); }

TEST(MemoryLimit, IsTheControlGroupsWhereThatIsLower) {
  EXPECT_EQ(usable(meminfo("12582912"), "4294967296\n"), 4 * kGiB);
  EXPECT_EQ(usable(meminfo("12582912"), "429496729600\n"), 13 * kGiB);
}

TEST(MemoryLimit, IsNoneWhereTheSystemDoesNotSay) {
  EXPECT_EQ(usable("", "4294967296\n"), std::nullopt);
  EXPECT_EQ(usable("MemTotal:       16777216 kB\n", ""), std::nullopt);
}

TEST(MemoryLimit, NeedsNoSwap) { EXPECT_EQ(usable("MemTotal: 8388608 kB\nMemAvailable: 6291456 kB\n", ""), 6 * kGiB); }

}  // namespace selvage::cli
