# Language level, warnings, the floating-point model and ccache: what every room shares.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

# A plain `cmake -B build` is for use: without a build type it would be compiled for no optimisation at all.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "As CMake's" FORCE)
endif()

if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(SELVAGE_CCACHE ccache)
  if(SELVAGE_CCACHE)
    # Where it may not write, as where packages are built without a home, it fails every compile: one is tried.
    file(WRITE "${PROJECT_BINARY_DIR}/CMakeFiles/ccache_trial.cpp" "int main() {}\n")
    execute_process(COMMAND "${SELVAGE_CCACHE}" "${CMAKE_CXX_COMPILER}" -c ccache_trial.cpp -o ccache_trial.o
      WORKING_DIRECTORY "${PROJECT_BINARY_DIR}/CMakeFiles" RESULT_VARIABLE failed ERROR_VARIABLE words OUTPUT_QUIET)
    if(failed)
      message(STATUS "ccache is not used, it fails here: ${words}")
      set(SELVAGE_CCACHE OFF)
    endif()
  endif()
  if(SELVAGE_CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${SELVAGE_CCACHE}")
    if(NOT DEFINED ENV{CCACHE_SLOPPINESS})
      # As its manual asks for precompiled headers: without, nothing that uses one is found again.
      list(PREPEND CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros)
    endif()
    add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  endif()
endif()

# Precompiled headers are for g++'s optimised builds. clang refuses those that ccache has from an earlier build, and what g++ 12
# inlines from them it takes for ours, and warns falsely (of which the options in tests/CMakeLists.txt are known to silence what
# an optimised build has).
if(PROJECT_IS_TOP_LEVEL AND NOT (CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release"))
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()

# What is said of an assertion that fails names the source from here on: what is built is the same wherever it was built.
add_compile_options("-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=")

add_library(selvage_warnings INTERFACE)
target_compile_options(selvage_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Wshadow $<$<BOOL:${SELVAGE_WERROR}>:-Werror>)
# In a unit of several sources g++ takes what one keeps to itself for another's, and warns of every type that uses it.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(selvage_warnings INTERFACE -Wno-subobject-linkage)
endif()

# Contraction to FMA changes bits between targets, and the error bounds assume that every operation is rounded, as it is written
# and in its order (K7). These stand behind the flags of whoever builds it (CMAKE_CXX_FLAGS), and take back what breaks proofs and
# has no macro in clang to refuse it by; sound_arithmetic.h of kernel and of verify refuses the rest. These two pass them on to their
# users: inline certified code compiles in their units.
set(SELVAGE_FP_OPTIONS
  -ffp-contract=off -fno-unsafe-math-optimizations -fno-associative-math -fno-reciprocal-math -fsigned-zeros)
add_library(selvage_fp_model INTERFACE)
# Where two doubles side by side become floats, and doubles again, g++ 12 -O2 takes them for unchanged, in this pass of its own
# (tests/kernel/rounding_test.cpp has the lines). No public header converts, so users keep it. Without it the curtain takes 1.02 of
# the processor time, kernel and checker as long.
target_compile_options(selvage_fp_model INTERFACE
  ${SELVAGE_FP_OPTIONS} $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)

# For which vector units lanes are compiled. Where AVX3_DL is the baseline (-march=native on an Ice Lake or later) Highway 1.0.3
# does not compile; AVX3 serves. On AArch64 NEON serves, which all of them have. Vectors of SVE have no size that a compiler knows,
# and so are members of nothing. And as one unit of several NEON would be compiled with an attribute that g++ does not give to the
# constructors which it makes itself, so that nothing could be chosen as the program starts: Highway does not where it takes the
# header for that to be missing.
add_library(selvage_vector_units INTERFACE)
target_link_libraries(selvage_vector_units INTERFACE hwy::hwy)
target_compile_definitions(selvage_vector_units INTERFACE
  "HWY_DISABLED_TARGETS=(HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)"
  $<$<STREQUAL:${CMAKE_SYSTEM_PROCESSOR},aarch64>:TOOLCHAIN_MISS_SYS_AUXV_H>)
