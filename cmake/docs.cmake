# cmake -DSOURCE=<source tree> -DOUTPUT=<folder> -P docs.cmake: the reference of the kernel's public API, kernel.h and the headers
# that it includes, as OUTPUT/html. Fails on any warning, which is anything public without a word about it.
cmake_minimum_required(VERSION 3.25)

find_program(DOXYGEN doxygen)
cmake_path(ABSOLUTE_PATH SOURCE NORMALIZE)
cmake_path(ABSOLUTE_PATH OUTPUT NORMALIZE)
if(NOT DOXYGEN)
  message("docs: skipped, doxygen is not installed (packages-docs.txt)")
  return()
endif()

file(STRINGS "${SOURCE}/kernel/kernel.h" lines REGEX "^#include \"kernel/")
set(headers kernel/kernel.h)
foreach(line ${lines})
  string(REGEX REPLACE ".*\"(.*)\".*" "\\1" header "${line}")
  list(APPEND headers ${header})
endforeach()
list(JOIN headers " " input)

file(MAKE_DIRECTORY "${OUTPUT}")
file(READ "${SOURCE}/Doxyfile" settings)
file(WRITE "${OUTPUT}/Doxyfile" "${settings}INPUT = ${input}\nOUTPUT_DIRECTORY = \"${OUTPUT}\"\n")
execute_process(COMMAND ${DOXYGEN} "${OUTPUT}/Doxyfile" WORKING_DIRECTORY "${SOURCE}" RESULT_VARIABLE failed ERROR_VARIABLE warnings)
if(failed OR warnings)
  message(FATAL_ERROR "docs: ${warnings}")
endif()
list(LENGTH headers count)
message("docs: ${count} headers, ${OUTPUT}/html/index.html")
