# cmake -DBUILD=<coverage build> -P coverage.cmake: runs the tests of the kernel and the checker, then prints line and branch
# coverage of the two rooms and writes the uncovered lines to BUILD/coverage.txt.
cmake_minimum_required(VERSION 3.25)

set(programs ${BUILD}/tests/kernel/kernel_tests ${BUILD}/tests/verify/verify_tests ${BUILD}/tests/fuzz/fuzz_tests)
file(GLOB old "${BUILD}/*.profraw")
file(REMOVE ${old})
set(objects "")
foreach(program ${programs})
  get_filename_component(name "${program}" NAME)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env "LLVM_PROFILE_FILE=${BUILD}/${name}.profraw" "${program}" --gtest_brief=1
    COMMAND_ERROR_IS_FATAL ANY)
  list(APPEND objects -object "${program}")
endforeach()
list(REMOVE_AT objects 0)  # the first program is named without -object
file(GLOB profiles "${BUILD}/*.profraw")
execute_process(COMMAND llvm-profdata-14 merge -sparse ${profiles} -o ${BUILD}/coverage.profdata COMMAND_ERROR_IS_FATAL ANY)

get_filename_component(root "${BUILD}/../.." ABSOLUTE)
set(rooms ${root}/kernel ${root}/verify)
execute_process(COMMAND llvm-cov-14 report ${objects} -instr-profile=${BUILD}/coverage.profdata ${rooms}
  COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND llvm-cov-14 show ${objects} -instr-profile=${BUILD}/coverage.profdata -region-coverage-lt=100 ${rooms}
  OUTPUT_FILE ${BUILD}/coverage.txt COMMAND_ERROR_IS_FATAL ANY)
message(STATUS "uncovered lines: ${BUILD}/coverage.txt")
