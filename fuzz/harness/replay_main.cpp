// Runs inputs without an engine, in any build.
//   fuzz_replay --corpus FOLDER TARGET...   FOLDER/TARGET/*: exactly these are the targets, every input holds, and the
//                                           inputs of each target show what that target says they must
//   fuzz_replay --seeds FOLDER TARGET...    writes inputs to start from, FOLDER/TARGET/*
//   fuzz_replay TARGET FILE...              single inputs; a failing one is printed as a case file
// Exit code 0: everything holds, 1: something failed, 2: wrong arguments.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>

#include "fuzz/base/deaths.h"
#include "fuzz/harness/fuzz_target.h"
#include "io/file/atomic_file.h"

namespace selvage::fuzz {
namespace {

namespace fs = std::filesystem;

TargetResult run_guarded(FuzzTarget& target, const std::string& input) {
  try {
    return target.run({reinterpret_cast<const std::uint8_t*>(input.data()), input.size()});
  } catch (const std::exception& error) {
    return {{}, std::string(kThrew) + ": " + error.what()};
  }
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (fs::is_directory(folder)) {
    for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

bool corpus_holds(FuzzTarget& target, const fs::path& folder) {
  target.prepare();
  bool holds = true;
  std::map<std::string, int> shown;
  const std::vector<fs::path> files = files_in(folder);
  for (const fs::path& file : files) {
    const TargetResult result = run_guarded(target, io::read_file(file));
    for (const std::string& word : result.shown) ++shown[word];
    if (result.failure.empty()) continue;
    std::printf("%s: %s\n", file.c_str(), result.failure.c_str());
    holds = false;
  }
  std::printf("%-14s %4zu inputs", target.name().c_str(), files.size());
  for (const auto& [word, count] : shown) std::printf("  %d %s", count, word.c_str());
  std::printf("\n");
  for (const std::string& word : target.must_show()) {
    if (shown.contains(word)) continue;
    std::printf("%s: no input shows '%s'\n", folder.c_str(), word.c_str());
    holds = false;
  }
  return holds;
}

bool all_corpora_hold(const fs::path& folder, std::vector<std::string> named) {
  bool holds = true;
  std::vector<std::string> names;
  for (const auto& target : fuzz_targets()) {
    names.push_back(target->name());
    holds = corpus_holds(*target, folder / target->name()) && holds;
  }
  std::ranges::sort(names);
  std::ranges::sort(named);
  if (names != named) {
    std::printf("the targets that the build names are not those that there are\n");
    holds = false;
  }
  return holds;
}

bool inputs_hold(FuzzTarget& target, const std::vector<std::string>& files) {
  target.prepare();
  bool holds = true;
  for (const std::string& file : files) {
    const std::string input = io::read_file(file);
    const TargetResult result = run_guarded(target, input);
    std::printf("%s: %s\n", file.c_str(), result.failure.empty() ? "holds" : result.failure.c_str());
    if (result.failure.empty()) continue;
    const Bytes bytes{reinterpret_cast<const std::uint8_t*>(input.data()), input.size()};
    std::printf("%s", target.kept(bytes, result.failure).c_str());
    holds = false;
  }
  return holds;
}

void write_seeds(const fs::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto target = fuzz_target(name);
    fs::create_directories(folder / target->name());
    target->prepare();
    const std::vector<std::string> seeds = target->seeds();
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      io::write_atomically(folder / target->name() / ("seed-" + std::to_string(i)), seeds[i]);
    }
  }
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 2) {
    std::fprintf(stderr, "usage: fuzz_replay --corpus FOLDER TARGET... | --seeds FOLDER TARGET... | TARGET FILE...\n");
    return 2;
  }
  const auto rest = [&](std::ptrdiff_t first) {
    return std::vector<std::string>(arguments.begin() + first, arguments.end());
  };
  if (arguments[0] == "--corpus") return all_corpora_hold(arguments[1], rest(2)) ? 0 : 1;
  if (arguments[0] != "--seeds") return inputs_hold(*fuzz_target(arguments[0]), rest(1)) ? 0 : 1;
  write_seeds(arguments[1], rest(2));
  return 0;
}

}  // namespace
}  // namespace selvage::fuzz

int main(int argc, char** argv) {
  try {
    return selvage::fuzz::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz_replay: %s\n", error.what());
    return 2;
  }
}
