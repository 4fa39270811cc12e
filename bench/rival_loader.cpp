#include "bench/rival_loader.h"

#include <dlfcn.h>

#include "kernel/fp_env.h"

namespace selvage::bench {
namespace {

struct Entry {
  void* function = nullptr;
  std::string absent;  ///< why there is none
};

Entry load(const std::filesystem::path& folder, const std::string& name, const char* function,
           const std::string& remedy) {
  const std::filesystem::path file = folder / ("selvage_rival_" + name + ".so");
  if (!std::filesystem::exists(file)) {
    return {nullptr, file.filename().string() + " is not in the build beside this program: " + remedy};
  }
  const FpEnvGuard guard;  // a library linked with -ffast-math changes the environment as it is loaded
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const entry = library == nullptr ? nullptr : dlsym(library, function);
  return {entry, entry == nullptr ? dlerror() : ""};
}

LoadedRival load_boxes(const std::filesystem::path& folder, const std::string& name, const std::string& remedy) {
  const Entry entry = load(folder, name, "selvage_make_rival", remedy);
  if (entry.function == nullptr) return {name, entry.absent, {}};
  const auto make = reinterpret_cast<MakeRival>(entry.function);  // POSIX's way from void* to a function
  return {name, {}, [make](int thread_count) { return std::unique_ptr<Rival>(make(thread_count)); }};
}

constexpr const char* kCgalRemedy = "it is built with the program and never installed, its licence being the GPL";

}  // namespace

std::vector<LoadedRival> load_rivals(const std::filesystem::path& folder) {
  return {load_boxes(folder, "cgal", kCgalRemedy),
          load_boxes(folder, "embree", "install libembree-dev (packages-rivals.txt), configure and build again")};
}

LoadedFrameRival load_frame_rival(const std::filesystem::path& folder) {
  const Entry entry = load(folder, "cgal_faces", "selvage_make_frame_rival", kCgalRemedy);
  if (entry.function == nullptr) return {entry.absent, {}};
  const auto make = reinterpret_cast<MakeFrameRival>(entry.function);
  return {{}, [make] { return std::unique_ptr<FrameRival>(make()); }};
}

std::filesystem::path rivals_beside_program() {
  std::error_code unknown;
  return std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path().parent_path() / "bench";
}

}  // namespace selvage::bench
