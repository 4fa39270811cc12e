# Install and export: find_package(Selvage) gives selvage::kernel, and selvage::sim, selvage::verify if built, with selvage::io.
include(CMakePackageConfigHelpers)

if(IS_ABSOLUTE "${CMAKE_INSTALL_INCLUDEDIR}")  # CMake's list of the headers would have it behind the prefix
  message(FATAL_ERROR "CMAKE_INSTALL_INCLUDEDIR is ${CMAKE_INSTALL_INCLUDEDIR}; it must be relative to the prefix, such as include")
endif()
get_property(rooms GLOBAL PROPERTY SELVAGE_ROOMS)
list(REMOVE_ITEM rooms selvage_fuzz selvage_bench)  # used through the program
install(TARGETS ${rooms} EXPORT SelvageTargets COMPONENT Development FILE_SET HEADERS COMPONENT Development)
install(FILES "${PROJECT_SOURCE_DIR}/fuzz/selvage-plugin.h" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/selvage/fuzz"  # C
  COMPONENT Development)
install(EXPORT SelvageTargets NAMESPACE selvage:: DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/Selvage" COMPONENT Development)
configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/SelvageConfig.cmake.in" "${PROJECT_BINARY_DIR}/SelvageConfig.cmake"
  INSTALL_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/Selvage")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/SelvageConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/SelvageConfig.cmake" "${PROJECT_BINARY_DIR}/SelvageConfigVersion.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/SelvageExactNumbers.cmake"
  DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/Selvage" COMPONENT Development)
