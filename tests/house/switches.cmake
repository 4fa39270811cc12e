# cmake -DSOURCE=<source tree> -DWORK=<folder> -DCOMPILER=<compiler> -P switches.cmake
# Configures with one switch off after the other: what is left must be complete. What needs a target that is not there takes its name
# for a library's, and fails only when it is linked.
cmake_minimum_required(VERSION 3.25)

set(switches VERIFY SIM FUZZ CLI TESTS)
set(programs_with_VERIFY_off "")
set(programs_with_SIM_off "")
set(programs_with_FUZZ_off "")
set(programs_with_CLI_off fuzz_replay)
set(programs_with_TESTS_off fuzz_replay selvage)
file(REMOVE_RECURSE "${WORK}")
foreach(off IN LISTS switches)
  set(options "")
  foreach(switch IN LISTS switches)
    list(APPEND options -DSELVAGE_${switch}=ON)
  endforeach()
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK} -G Ninja -DCMAKE_CXX_COMPILER=${COMPILER} ${options}
    -DSELVAGE_${off}=OFF RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    message(FATAL_ERROR "without ${off}:\n${output}")
  endif()
  file(STRINGS "${WORK}/build.ninja" unknown REGEX "-lselvage")
  if(unknown)
    message(FATAL_ERROR "without ${off}: ${unknown}")
  endif()
  file(STRINGS "${WORK}/build.ninja" rules REGEX "^build (selvage|fuzz_replay|kernel_tests): phony")
  string(REGEX MATCHALL "selvage|fuzz_replay|kernel_tests" programs "${rules}")
  list(REMOVE_DUPLICATES programs)
  list(SORT programs)
  if(NOT programs STREQUAL "${programs_with_${off}_off}")
    message(FATAL_ERROR "without ${off}: ${programs} are built")
  endif()
endforeach()

# What is off with it is named, for whoever had it on by default as well.
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/by_default -G Ninja -DCMAKE_CXX_COMPILER=${COMPILER}
  -DSELVAGE_SIM=OFF -DSELVAGE_TESTS=OFF OUTPUT_VARIABLE output ERROR_VARIABLE output)
string(REGEX MATCHALL "SELVAGE_[A-Z]+ is off" named "${output}")
if(NOT named STREQUAL "SELVAGE_FUZZ is off;SELVAGE_CLI is off")
  message(FATAL_ERROR "without the simulator it is said of '${named}' that it is off:\n${output}")
endif()
