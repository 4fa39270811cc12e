// What can be seen of another process from outside: how long it has computed, and whether it sleeps.
#pragma once

#include <optional>

#include <sys/types.h>

namespace selvage::fuzz {

/// Of all its threads. Nothing where it has died.
[[nodiscard]] std::optional<double> processor_seconds(pid_t process);
/// Whether none of its threads runs, waits for a processor or for a disk: all sleep, or were stopped.
[[nodiscard]] bool is_asleep(pid_t process);

}  // namespace selvage::fuzz
