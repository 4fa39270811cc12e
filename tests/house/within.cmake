# cmake -DSOURCE=<source tree> -DWORK=<folder> -DCOMPILER=<compiler> -DTARGETS=<targets> [-DCCACHE=<program>] [-DALL_FLAGS=<flags>]
#   [-DOWN_FLAGS=<flags>] [-DPROGRAM=<target>] -P within.cmake
# Configures tests/house/parent, a project that adds Selvage by add_subdirectory, once for every element of ALL_FLAGS in the same
# folder, and builds TARGETS. PROGRAM, if given, is run, and the project must neither test nor install anything of Selvage's.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${WORK}")
if(NOT ALL_FLAGS)
  set(ALL_FLAGS -O0)  # it is soon built, and soon has run
endif()
foreach(flags IN LISTS ALL_FLAGS)
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/parent -B ${WORK}/build -G Ninja -DCMAKE_CXX_COMPILER=${COMPILER}
    "-DCMAKE_CXX_COMPILER_LAUNCHER=${CCACHE}" -DSELVAGE=${SOURCE} "-DALL_FLAGS=${flags}" "-DOWN_FLAGS=${OWN_FLAGS}")
endforeach()
run(${CMAKE_COMMAND} --build ${WORK}/build --target ${TARGETS})

if(PROGRAM)
  run(${WORK}/build/${PROGRAM})
  message("${output}")
  run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/build -N)
  if(NOT output MATCHES "Total Tests: 0\n")
    message(FATAL_ERROR "Selvage's tests have become its parent's:\n${output}")
  endif()
  run(${CMAKE_COMMAND} --install ${WORK}/build --prefix ${WORK}/prefix)
  file(GLOB_RECURSE installed "${WORK}/prefix/*")
  if(installed)
    message(FATAL_ERROR "Selvage's files are installed with its parent: ${installed}")
  endif()
endif()
