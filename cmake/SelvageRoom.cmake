# selvage_room(NAME SOURCES ... HEADERS ... PUBLIC ... PRIVATE ...)
#   Makes the static library selvage_NAME with the alias selvage::NAME from the folder that calls it.
#   Inside the tree headers are "NAME/x.h"; installed they are <selvage/NAME/x.h>.
function(selvage_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  set(target selvage_${name})
  add_library(${target} STATIC ${ROOM_SOURCES})
  add_library(selvage::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${ROOM_HEADERS})
  target_include_directories(${target} INTERFACE
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>          # <selvage/kernel/ccd.h>, as users write it
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/selvage>)  # "kernel/ccd.h", as the headers include each other
  target_compile_features(${target} INTERFACE cxx_std_20)
  target_compile_definitions(${target} INTERFACE $<INSTALL_INTERFACE:SELVAGE_EIGEN_LAYOUT=${SELVAGE_EIGEN_LAYOUT}>)
  target_link_libraries(${target}
    PUBLIC ${ROOM_PUBLIC}
    PRIVATE ${ROOM_PRIVATE} $<BUILD_INTERFACE:selvage_warnings> $<BUILD_INTERFACE:selvage_fp_model>)
  set_property(GLOBAL APPEND PROPERTY SELVAGE_ROOMS ${target})
endfunction()
