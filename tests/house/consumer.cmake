# Installs the package into an empty folder, then configures, builds and runs SOURCE against it, as another project would.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
  message("${output}")
endfunction()

file(REMOVE_RECURSE "${WORK}")
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
if(NOT EXISTS "${WORK}/prefix/include/selvage/fuzz/selvage-plugin.h")
  message(FATAL_ERROR "the header of plugins is not installed")
endif()
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix
  -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK}/build)
if(VERIFY)  # so many steps that it records are exactly free of intersections
  run(${WORK}/build/${PROGRAM} ${STEPS} ${WORK}/steps)
  run(${VERIFY} verify ${WORK}/steps)
else()
  run(${WORK}/build/${PROGRAM})
endif()
