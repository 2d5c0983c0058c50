# cmake -DCOMPILE="<compiler;options>" -DFILE=<file> -P compile_fail_test.cmake
# The file compiles, and with EMAX_BRANCH it does not, because of the condition in its `if`.
execute_process(COMMAND ${COMPILE} ${FILE} RESULT_VARIABLE status ERROR_VARIABLE errors)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "the positive control does not compile:\n${errors}")
endif()
execute_process(COMMAND ${COMPILE} -DEMAX_BRANCH ${FILE}
  RESULT_VARIABLE status ERROR_VARIABLE errors)
if(status EQUAL 0)
  message(FATAL_ERROR "an if on a recorded condition compiles")
endif()
if(NOT errors MATCHES "RecordedCondition.*bool")
  message(FATAL_ERROR "it fails for another reason:\n${errors}")
endif()
