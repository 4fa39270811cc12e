# cmake -DSOURCE=<source tree> -DBUILD=<coverage build> -P coverage.cmake: runs the kernel's tests and fails if a line or a branch of
# kernel/ was not reached that docs/measurements/coverage.md does not excuse, or if it excuses one that was. The annotated sources are in
# BUILD/coverage.txt.
cmake_minimum_required(VERSION 3.25)
cmake_path(ABSOLUTE_PATH SOURCE NORMALIZE)
cmake_path(ABSOLUTE_PATH BUILD NORMALIZE)
string(REGEX REPLACE "/$" "" SOURCE "${SOURCE}")

set(program ${BUILD}/tests/kernel/kernel_tests)
if(NOT REPORT_ONLY)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env "LLVM_PROFILE_FILE=${BUILD}/kernel.profraw" "${program}" --gtest_brief=1
    COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND llvm-profdata-14 merge -sparse ${BUILD}/kernel.profraw -o ${BUILD}/kernel.profdata
    COMMAND_ERROR_IS_FATAL ANY)
endif()
# Paths as the compiler recorded them: a folder given as a source would have to match them.
set(sources "${program}" -instr-profile=${BUILD}/kernel.profdata "-ignore-filename-regex=/(tests|io|verify)/|^/usr/")
execute_process(COMMAND llvm-cov-14 show -show-branches=count -show-instantiations=false ${sources}
  OUTPUT_FILE ${BUILD}/coverage.txt COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND llvm-cov-14 report ${sources} OUTPUT_VARIABLE report COMMAND_ERROR_IS_FATAL ANY)
message("${report}")
execute_process(COMMAND awk -v root=${SOURCE}/ -f ${SOURCE}/cmake/coverage.awk ${SOURCE}/docs/measurements/coverage.md ${BUILD}/coverage.txt
  RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "coverage: see above; the annotated sources are in ${BUILD}/coverage.txt")
endif()
