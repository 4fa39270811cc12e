// The environment that somebody else's library leaves behind: seen by fp_env_defects, repaired by the guard, in the
// process that loads the library at run time, in threads it starts, and in one that was preloaded with it.
#include <cfenv>
#include <cstdlib>
#include <thread>

#include <dlfcn.h>
#include <gtest/gtest.h>

#include "kernel/ccd.h"
#include "kernel/fp_env.h"

namespace selvage {

namespace {

constexpr unsigned kFlushing = kFpFlush | kFpDenormals;

/// Two points of subnormal size that touch half way, as vertex and face, and one that stays a subnormal away.
std::array<Vec3, 4> face_below(double height) {
  return {Vec3(0, 0, height), Vec3(-0x1p-1070, -0x1p-1070, 0), Vec3(0x1p-1069, -0x1p-1070, 0),
          Vec3(-0x1p-1070, 0x1p-1069, 0)};
}

void expect_subnormal_queries_answered() {
  constexpr CcdOptions kNoTolerance{.tolerance = 0};
  EXPECT_EQ(vf_ccd(face_below(0x1p-1072), face_below(-0x1p-1072), kNoTolerance).verdict, CcdVerdict::kCollides);
  EXPECT_EQ(vf_ccd(face_below(0x1p-1072), face_below(0x1p-1074), kNoTolerance).verdict, CcdVerdict::kSeparated);
}

/// What the guard cannot repair.
unsigned defects_under_guard() {
  const FpEnvGuard guard;
  return fp_env_defects();
}

}  // namespace

TEST(FastMathLibrary, LoadedAtRunTimeIsSeenAndRepaired) {
  std::fenv_t clean;
  std::fegetenv(&clean);
  void* library = dlopen(SELVAGE_FAST_MATH_LIBRARY, RTLD_NOW);
  const unsigned defects = fp_env_defects();
  unsigned repaired = 1, inherited = 0;
  std::thread([&inherited] { inherited = fp_env_defects(); }).join();
  if (library != nullptr && (defects & kFlushing) == kFlushing) {
    repaired = defects_under_guard();
    expect_subnormal_queries_answered();
  }
  const unsigned after = fp_env_defects();
  std::fesetenv(&clean);
  ASSERT_NE(library, nullptr) << dlerror();
  if ((defects & kFlushing) == 0) GTEST_SKIP() << "this compiler's -ffast-math leaves the environment alone";
  EXPECT_EQ(defects & kFlushing, kFlushing);
  EXPECT_EQ(inherited, defects);
  EXPECT_EQ(repaired, 0U);
  EXPECT_EQ(after, defects) << "the caller's environment is the caller's";
  EXPECT_EQ(fp_env_defects(), 0U);
}

// Run once more with the library preloaded (CMakeLists.txt), where the defects are there from the start.
TEST(FastMathLibrary, PreloadedIsSeenAndRepaired) {
  if (std::getenv("SELVAGE_PRELOADED_FAST_MATH") == nullptr) GTEST_SKIP() << "not preloaded: another test does it";
  ASSERT_NE(dlsym(RTLD_DEFAULT, "fast_math_library_half"), nullptr) << "the library was not preloaded";
  if ((fp_env_defects() & kFlushing) == 0) GTEST_SKIP() << "this compiler's -ffast-math leaves the environment alone";
  EXPECT_EQ(fp_env_defects() & kFlushing, kFlushing);
  EXPECT_EQ(defects_under_guard(), 0U);
  expect_subnormal_queries_answered();
}

}  // namespace selvage
