// The program's exit codes, and the one place where exceptions become exit codes.
#pragma once

#include <exception>
#include <functional>
#include <stdexcept>
#include <string>

namespace selvage::cli {

enum class ExitCode : int {
  kClean = 0,
  kViolation = 1,
  kUsage = 2,
  kBadInput = 3,
  kFile = 4,
  kLimit = 5,  ///< a limit was reached, the answer is unknown: never clean
  kFpEnvironment = 6,
  kInternal = 7,
  kInterrupted = 75,  ///< stopped by a signal; run again to resume
};

/// The command line is well formed but asks for something that makes no sense: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The floating-point environment breaks the proofs and cannot be repaired: exit code 6.
class FpEnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the chosen subcommand does once the whole command line is parsed.
using Job = std::function<ExitCode()>;

/// An exception as the user learns of it.
struct Failure {
  ExitCode code = ExitCode::kInternal;
  std::string message;
};
[[nodiscard]] Failure failure_of(const std::exception_ptr& exception);

/// Runs `job`; an exception becomes one line on stderr and its exit code. Lost output on stdout is kFile: a result
/// that nobody received must not look like success.
[[nodiscard]] ExitCode run_guarded(const Job& job);

}  // namespace selvage::cli
