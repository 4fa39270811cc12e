// SIGINT and SIGTERM ask for a clean stop: the work in hand is finished and written. A second signal kills.
#pragma once

namespace selvage::cli {

/// To be called once, before work starts.
void catch_interrupts();
/// Whether a signal has arrived. Cheap; may be called from any thread.
[[nodiscard]] bool interrupted() noexcept;

}  // namespace selvage::cli
