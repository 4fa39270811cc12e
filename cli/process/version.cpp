#include "cli/process/version.h"

#include <Eigen/Core>
#include <fmt/format.h>
#include <tbb/version.h>

#include "kernel/version.h"
#include "verify/report/library_versions.h"

namespace selvage::cli {

std::string version_text() {
  return fmt::format("selvage {}\n{}, Eigen {}.{}.{}, oneTBB {}, {}", SELVAGE_VERSION, verify::library_versions(),
                     EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, TBB_runtime_version(),
#ifdef __clang__
                     "clang++ " __clang_version__
#else
                     "g++ " __VERSION__
#endif
  );
}

}  // namespace selvage::cli
