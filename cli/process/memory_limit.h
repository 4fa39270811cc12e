// More memory than there is ends in an error, "out of memory" (exit code 5). Without a limit the system hands out what
// it does not have, and kills the program without a word once it is used: a sheet of 10,000 x 10,000 vertices by a slip
// of the hand.
#pragma once

#include <cstdint>
#include <istream>
#include <optional>

namespace selvage::cli {

/// Bytes that a program which starts now can use: what is free, memory and swap, or half of the memory if more, since
/// what others hold for the moment is given back; not more than the control group's limit. By the texts of
/// /proc/meminfo and of memory.max (cgroup v2); nothing where the first does not say.
[[nodiscard]] std::optional<std::uint64_t> usable_memory(std::istream& meminfo, std::istream& group_limit);

/// To be called once, before work starts. A lower limit that is set already stays; where the system says nothing of its
/// memory, none is set. Counted are writable pages of the process alone, mapped files are not.
void make_lack_of_memory_an_error();

}  // namespace selvage::cli
