#include "cli/exit_code.h"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>

#include "io/error.h"
#include "io/fail.h"
#include "io/text.h"

namespace selvage::cli {
namespace {

/// What holds a file's own text, such as the name of a group, neither breaks the line nor commands the terminal.
ExitCode failed(ExitCode code, const char* what) {
  std::fprintf(stderr, "selvage: %s\n", io::printable(what).c_str());
  return code;
}

/// What the standard library says of a path, in the words of all other files.
ExitCode run(const Job& job) {
  try {
    return job();
  } catch (const std::filesystem::filesystem_error& error) {
    io::file_error(error.path1().string(), "use", error.code().value());
  }
}

}  // namespace

ExitCode run_guarded(const Job& job) {
  try {
    const ExitCode code = run(job);
    std::cout.flush();
    if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      return failed(ExitCode::kFile, "cannot write the result to standard output");
    }
    return code;
  } catch (const UsageError& error) {
    return failed(ExitCode::kUsage, error.what());
  } catch (const io::Error& error) {
    return failed(error.kind() == io::ErrorKind::kBadInput ? ExitCode::kBadInput : ExitCode::kFile, error.what());
  } catch (const FpEnvironmentError& error) {
    return failed(ExitCode::kFpEnvironment, error.what());
  } catch (const std::bad_alloc&) {
    return failed(ExitCode::kLimit, "out of memory: nothing is known about the rest");
  } catch (const std::exception& error) {
    return failed(ExitCode::kInternal, error.what());
  }
}

}  // namespace selvage::cli
