#include "bench/rival_loader.h"

#include <dlfcn.h>

#include "kernel/fp_env.h"

namespace selvage::bench {
namespace {

LoadedRival load(const std::filesystem::path& folder, const std::string& name, const std::string& remedy) {
  LoadedRival rival{name, {}, {}};
  const std::filesystem::path file = folder / ("selvage_rival_" + name + ".so");
  if (!std::filesystem::exists(file)) {
    rival.absent = file.filename().string() + " is not in the build beside this program: " + remedy;
    return rival;
  }
  const FpEnvGuard guard;  // a library linked with -ffast-math changes the environment as it is loaded
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  // POSIX's way from void* to a function
  const auto make = library == nullptr ? nullptr : reinterpret_cast<MakeRival>(dlsym(library, "selvage_make_rival"));
  if (make == nullptr) {
    rival.absent = dlerror();
    return rival;
  }
  rival.create = [make](int thread_count) { return std::unique_ptr<Rival>(make(thread_count)); };
  return rival;
}

}  // namespace

std::vector<LoadedRival> load_rivals(const std::filesystem::path& folder) {
  return {load(folder, "cgal", "it is built with the program and never installed, its licence being the GPL"),
          load(folder, "embree", "install libembree-dev (packages-rivals.txt), configure and build again")};
}

std::filesystem::path rivals_beside_program() {
  std::error_code unknown;
  return std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path().parent_path() / "bench";
}

}  // namespace selvage::bench
