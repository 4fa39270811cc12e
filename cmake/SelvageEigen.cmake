# SELVAGE_EIGEN_LAYOUT: how Eigen aligns and allocates under these flags, for kernel/types.h to compare in users' code.
include(CheckCXXSourceCompiles)

string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
set(CMAKE_REQUIRED_FLAGS "${CMAKE_CXX_FLAGS_${config}}")
get_target_property(CMAKE_REQUIRED_INCLUDES Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
foreach(layout 33 32 65 64 129 128)
  check_cxx_source_compiles("
    #include <Eigen/Core>
    static_assert(2 * EIGEN_DEFAULT_ALIGN_BYTES + EIGEN_MALLOC_ALREADY_ALIGNED == ${layout});
    int main() {}" SELVAGE_EIGEN_LAYOUT_IS_${layout})
  if(SELVAGE_EIGEN_LAYOUT_IS_${layout})
    set(SELVAGE_EIGEN_LAYOUT ${layout})
    break()
  endif()
endforeach()
unset(CMAKE_REQUIRED_INCLUDES)
unset(CMAKE_REQUIRED_FLAGS)
if(NOT SELVAGE_EIGEN_LAYOUT)
  message(FATAL_ERROR "Eigen aligns its matrices in a way that cmake/SelvageEigen.cmake does not know; add it there")
endif()
