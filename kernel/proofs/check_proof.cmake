# cmake -DGAPPA=program -DPROOF=file.gappa -P check_proof.cmake: fails unless Gappa proves every property in the file.
if(NOT GAPPA)
  message("gappa is not installed: ${PROOF} was not checked")
  return()
endif()
execute_process(COMMAND "${GAPPA}" INPUT_FILE "${PROOF}" RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0 OR output MATCHES "Error|Warning")
  message(FATAL_ERROR "${PROOF}: not proved\n${output}")
endif()
