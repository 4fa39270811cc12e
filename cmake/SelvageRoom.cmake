# compile_alone(TARGET FILES...): these sources of the target's stay out of its unity build. Files are relative to the project.
function(compile_alone target)
  list(TRANSFORM ARGN PREPEND "${PROJECT_SOURCE_DIR}/")
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# selvage_room(NAME SOURCES ... [LANES ...] HEADERS ... PUBLIC ... PRIVATE ...)
#   Makes the static library selvage_NAME with the alias selvage::NAME from the folder that calls it.
#   LANES are sources that include themselves, once for each vector unit (Highway).
#   Inside the tree headers are "NAME/x.h"; for users, installed or not, they are <selvage/NAME/x.h>.
function(selvage_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LANES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  set(target selvage_${name})
  add_library(${target} STATIC ${ROOM_SOURCES} ${ROOM_LANES})
  list(TRANSFORM ROOM_LANES PREPEND "${name}/")
  compile_alone(${target} ${ROOM_LANES})
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
