# compile_alone(TARGET FILES...): these sources of the target's stay out of its unity build. Files are relative to the project.
function(compile_alone target)
  list(TRANSFORM ARGN PREPEND "${PROJECT_SOURCE_DIR}/")
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# public_headers(TARGET NAME HEADERS...): the headers of the room NAME as public_headers.cmake writes them, for users who
# install Selvage and for those who add it to their project.
function(public_headers target name)
  set(public "${PROJECT_BINARY_DIR}/public_headers")
  list(TRANSFORM ARGN PREPEND "${name}/")
  list(TRANSFORM ARGN PREPEND "${PROJECT_SOURCE_DIR}/" OUTPUT_VARIABLE originals)
  list(TRANSFORM ARGN PREPEND "${public}/selvage/" OUTPUT_VARIABLE written)
  set(script "${PROJECT_SOURCE_DIR}/cmake/public_headers.cmake")
  set(stamp "${CMAKE_CURRENT_BINARY_DIR}/public_headers.stamp")
  add_custom_command(OUTPUT "${stamp}" BYPRODUCTS ${written}
    COMMAND ${CMAKE_COMMAND} "-DFROM=${PROJECT_SOURCE_DIR}" "-DTO=${public}" "-DHEADERS=${ARGN}" -P "${script}"
    COMMAND ${CMAKE_COMMAND} -E touch "${stamp}"
    DEPENDS ${originals} "${script}" VERBATIM)
  target_sources(${target} PRIVATE "${stamp}" PUBLIC FILE_SET HEADERS BASE_DIRS "${public}" FILES ${written})
endfunction()

if(BUILD_SHARED_LIBS)
  message(STATUS "Selvage's libraries are static: BUILD_SHARED_LIBS is not for them")
endif()

# selvage_room(NAME SOURCES ... [LANES ...] [HEADERS ...] PUBLIC ... PRIVATE ...)
#   Makes the static library selvage_NAME with the alias selvage::NAME from the folder that calls it.
#   LANES are sources that include themselves, once for each vector unit (Highway).
#   Inside the tree headers are "NAME/x.h"; for users, installed or not, HEADERS are <selvage/NAME/x.h>: what they
#   include, and what that includes. A room that is used through the program alone names none.
function(selvage_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LANES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
  set(target selvage_${name})
  add_library(${target} STATIC ${ROOM_SOURCES} ${ROOM_LANES})
  list(TRANSFORM ROOM_LANES PREPEND "${name}/")
  compile_alone(${target} ${ROOM_LANES})
  add_library(selvage::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  if(ROOM_HEADERS)
    public_headers(${target} ${name} ${ROOM_HEADERS})
  endif()
  target_compile_features(${target} INTERFACE cxx_std_20)
  target_link_libraries(${target}
    PUBLIC ${ROOM_PUBLIC}
    PRIVATE ${ROOM_PRIVATE} $<BUILD_INTERFACE:selvage_warnings> $<BUILD_INTERFACE:selvage_fp_model>)
  set_property(GLOBAL APPEND PROPERTY SELVAGE_ROOMS ${target})
endfunction()
