// SIGINT, SIGTERM and SIGHUP ask for a clean stop: the work in hand is finished and written. What comes within half a second of
// the first is the same request, which a launcher and the terminal may both deliver; a later signal kills, and the
// first does where a command has no work to stop in between. A file that would grow beyond `ulimit -f` is an error of
// the write, which cleans up behind itself, and no signal.
#pragma once

namespace selvage::cli {

/// To be called once, before work starts, by commands that ask interrupted() in between: others would be deaf.
void catch_interrupts();
/// Whether a signal has arrived. Cheap; may be called from any thread.
[[nodiscard]] bool interrupted() noexcept;
/// To be called once, before anything is written.
void make_size_limits_errors();

}  // namespace selvage::cli
