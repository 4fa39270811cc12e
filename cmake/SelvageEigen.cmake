# SELVAGE_EIGEN_LAYOUT: how Eigen aligns and allocates under these flags, and SELVAGE_CHECKED_CONTAINERS: whether containers of the
# standard library check themselves; for kernel/types.h to compare in every unit.
include(CheckCXXSourceCompiles)

# Options of this folder come beside CMAKE_CXX_FLAGS: those that a project around this one gives to all that it builds.
get_directory_property(options COMPILE_OPTIONS)
get_directory_property(definitions COMPILE_DEFINITIONS)
add_library(selvage_folder_flags INTERFACE IMPORTED)
set_target_properties(selvage_folder_flags PROPERTIES
  INTERFACE_COMPILE_OPTIONS "${options}" INTERFACE_COMPILE_DEFINITIONS "${definitions}")

string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
set(CMAKE_REQUIRED_FLAGS "${CMAKE_CXX_FLAGS_${config}}")
set(CMAKE_REQUIRED_LIBRARIES selvage_folder_flags Eigen3::Eigen)
# CMake keeps answers for as long as the build folder lives: each is to the flags in its name.
string(MD5 flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}} ${options} ${definitions}")
foreach(layout 33 32 65 64 129 128)
  check_cxx_source_compiles("
    #include <Eigen/Core>
    static_assert(2 * EIGEN_DEFAULT_ALIGN_BYTES + EIGEN_MALLOC_ALREADY_ALIGNED == ${layout});
    int main() {}" SELVAGE_EIGEN_LAYOUT_IS_${layout}_${flags})
  if(SELVAGE_EIGEN_LAYOUT_IS_${layout}_${flags})
    set(SELVAGE_EIGEN_LAYOUT ${layout})
    break()
  endif()
endforeach()
check_cxx_source_compiles("
  #include <vector>
  #ifndef _GLIBCXX_DEBUG
  #error
  #endif
  int main() {}" SELVAGE_CHECKS_CONTAINERS_${flags})
set(SELVAGE_CHECKED_CONTAINERS 0)
if(SELVAGE_CHECKS_CONTAINERS_${flags})
  set(SELVAGE_CHECKED_CONTAINERS 1)
endif()
unset(CMAKE_REQUIRED_LIBRARIES)
unset(CMAKE_REQUIRED_FLAGS)
if(NOT SELVAGE_EIGEN_LAYOUT)
  message(FATAL_ERROR "Eigen aligns its matrices in a way that cmake/SelvageEigen.cmake does not know; add it there")
endif()
