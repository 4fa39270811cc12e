# selvage_room(NAME SOURCES ... HEADERS ... PUBLIC ... PRIVATE ...)
#   Makes the static library selvage_NAME with the alias selvage::NAME from the folder that calls it.
#   Inside the tree headers are "NAME/x.h"; for users, installed or not, they are <selvage/NAME/x.h>.
function(selvage_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  set(target selvage_${name})
  add_library(${target} STATIC ${ROOM_SOURCES})
  add_library(selvage::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${ROOM_HEADERS})
  file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/include/selvage")
  file(CREATE_LINK "${CMAKE_CURRENT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}/include/selvage/${name}" SYMBOLIC)
  target_include_directories(${target} INTERFACE
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>          # <selvage/kernel/ccd.h>, as users write it
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/selvage>)  # "kernel/ccd.h", as the headers include each other
  target_compile_features(${target} INTERFACE cxx_std_20)
  target_link_libraries(${target}
    PUBLIC ${ROOM_PUBLIC}
    PRIVATE ${ROOM_PRIVATE} $<BUILD_INTERFACE:selvage_warnings> $<BUILD_INTERFACE:selvage_fp_model>)
  set_property(GLOBAL APPEND PROPERTY SELVAGE_ROOMS ${target})
endfunction()
