// Plain data through pipes, whole or not at all.
#pragma once

#include <cerrno>
#include <climits>
#include <system_error>
#include <type_traits>

#include <unistd.h>

namespace selvage::fuzz {

/// False where the reader is gone. What is this short goes through a pipe in one piece, so a kill leaves no half.
template <class Message>
[[nodiscard]] bool try_send(int pipe, const Message& message) {
  static_assert(std::is_trivially_copyable_v<Message> && sizeof(Message) <= _POSIX_PIPE_BUF);
  ssize_t written = 0;
  do {
    written = write(pipe, &message, sizeof(Message));
  } while (written < 0 && errno == EINTR);
  if (written < 0 && errno == EPIPE) return false;
  if (written != static_cast<ssize_t>(sizeof(Message))) throw std::system_error(errno, std::generic_category(), "pipe");
  return true;
}

/// Throws where the reader is gone.
template <class Message>
void send(int pipe, const Message& message) {
  if (!try_send(pipe, message)) throw std::system_error(EPIPE, std::generic_category(), "pipe");
}

/// False at the end of the pipe.
template <class Message>
bool receive(int pipe, Message& message) {
  ssize_t count = 0;
  do {
    count = read(pipe, &message, sizeof(Message));
  } while (count < 0 && errno == EINTR);
  if (count < 0) throw std::system_error(errno, std::generic_category(), "pipe");
  return count == static_cast<ssize_t>(sizeof(Message));
}

}  // namespace selvage::fuzz
