#include "cli/process/exit_code.h"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include "io/error.h"
#include "io/fail.h"
#include "io/file/text.h"

namespace selvage::cli {
namespace {

constexpr const char* kLostOutput =
    "cannot write the result to standard output; send it to a file on a disk with room, or to a program that reads it";

/// What holds a file's own text, such as the name of a group, neither breaks the line nor commands the terminal.
ExitCode failed(const Failure& failure) {
  std::fprintf(stderr, "selvage: %s\n", io::printable(failure.message).c_str());
  return failure.code;
}

}  // namespace

Failure failure_of(const std::exception_ptr& exception) {
  try {
    std::rethrow_exception(exception);
  } catch (const UsageError& error) {
    return {ExitCode::kUsage, error.what()};
  } catch (const io::Error& error) {
    return {error.kind() == io::ErrorKind::kBadInput ? ExitCode::kBadInput : ExitCode::kFile, error.what()};
  } catch (const std::filesystem::filesystem_error& error) {
    try {  // what the standard library says of a path, in the words of all other files
      io::file_error(error.path1().string(), "use", error.code().value());
    } catch (const io::Error& in_words) {
      return {ExitCode::kFile, in_words.what()};
    }
  } catch (const FpEnvironmentError& error) {
    return {ExitCode::kFpEnvironment, error.what()};
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) return {ExitCode::kFile, kLostOutput};  // thrown where it is printed
    return {ExitCode::kInternal, error.what()};
  } catch (const std::bad_alloc&) {
    return {ExitCode::kLimit, "out of memory: nothing is known about the rest; a coarser mesh or a shard needs less"};
  } catch (const std::exception& error) {
    return {ExitCode::kInternal, error.what()};
  }
}

ExitCode run_guarded(const Job& job) {
  try {
    const ExitCode code = job();
    std::cout.flush();
    if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      return failed({ExitCode::kFile, kLostOutput});
    }
    return code;
  } catch (const std::exception&) {
    return failed(failure_of(std::current_exception()));
  }
}

}  // namespace selvage::cli
