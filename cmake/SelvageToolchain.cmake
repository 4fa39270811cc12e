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
    set(CMAKE_CXX_COMPILER_LAUNCHER "${SELVAGE_CCACHE}")
  endif()
endif()

add_library(selvage_warnings INTERFACE)
target_compile_options(selvage_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wdouble-promotion -Wshadow $<$<BOOL:${SELVAGE_WERROR}>:-Werror>)

# Contraction to FMA changes bits between targets, and the error bounds assume every operation is rounded (K7).
# The kernel alone passes the option on to its users: inline certified code compiles in their units.
add_library(selvage_fp_model INTERFACE)
target_compile_options(selvage_fp_model INTERFACE -ffp-contract=off)
