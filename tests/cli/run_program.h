// Runs the program as a child process and collects what it leaves behind.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/temporary_folder.h"

namespace selvage::testing {

struct ProgramResult {
  int exit_code = -1;  ///< -1: killed by a signal
  std::string out, err;
};

/// Starts the program with stdout and stderr in files of `folder`; the caller waits for it.
inline pid_t start_program(const std::filesystem::path& folder, std::vector<std::string> arguments,
                           const char* program = SELVAGE_PROGRAM) {
  const pid_t child = fork();
  if (child != 0) return child;
  const auto redirect = [](const std::filesystem::path& file, int descriptor) {
    const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
  };
  redirect(folder / "stdout.txt", STDOUT_FILENO);
  redirect(folder / "stderr.txt", STDERR_FILENO);
  arguments.insert(arguments.begin(), program);
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  execv(program, argv.data());
  _exit(127);
}

/// Returns once the child has a handler for the signal: before that it would die of it.
inline void wait_until_signal_is_caught(pid_t child, int signal) {
  for (int i = 0; i < 6000; ++i) {
    const std::string status = slurp("/proc/" + std::to_string(child) + "/status");
    const std::size_t at = status.find("SigCgt:");
    if (at != std::string::npos && (std::stoull(status.substr(at + 7), nullptr, 16) >> (signal - 1) & 1) != 0) return;
    usleep(10000);
  }
  ADD_FAILURE() << "the program does not catch signal " << signal;
}

/// Returns once a signal that was sent to the child is no longer waiting for it, or has killed it.
inline void wait_until_signal_is_taken(pid_t child, int signal) {
  for (int i = 0; i < 60000; ++i) {
    const std::string status = slurp("/proc/" + std::to_string(child) + "/status");
    const std::size_t at = status.find("ShdPnd:");
    if (at == std::string::npos || status.find("State:\tZ") != std::string::npos) return;
    if ((std::stoull(status.substr(at + 7), nullptr, 16) >> (signal - 1) & 1) == 0) return;
    usleep(1000);
  }
  ADD_FAILURE() << "the program does not take signal " << signal;
}

inline ProgramResult wait_for_program(const std::filesystem::path& folder, pid_t child) {
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(folder / "stdout.txt"), slurp(folder / "stderr.txt")};
}

inline ProgramResult run_program(const TemporaryFolder& folder, std::vector<std::string> arguments,
                                 const char* program = SELVAGE_PROGRAM) {
  return wait_for_program(folder.path(), start_program(folder.path(), std::move(arguments), program));
}
inline ProgramResult run_program(std::vector<std::string> arguments) {
  return run_program(TemporaryFolder{}, std::move(arguments));
}

inline void expect_text(const std::string& text, const std::string& fragment) {
  EXPECT_NE(text.find(fragment), std::string::npos) << "expected: " << fragment << "\nin: " << text;
}

}  // namespace selvage::testing
