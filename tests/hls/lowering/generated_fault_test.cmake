# The comparison of generated_test.cmake must see one changed byte, and a file too many.
foreach(fault byte file)
  set(copy ${WORK}/${fault}/generated)
  file(REMOVE_RECURSE ${copy})
  file(COPY ${FOLDER}/ DESTINATION ${copy})
  if(fault STREQUAL byte)
    file(APPEND ${copy}/emax_distance.sv "\n")
    set(expected "ninja generate_rtl")
  else()
    file(WRITE ${copy}/stray.sv "")
    set(expected "holds.*stray.sv")
  endif()
  execute_process(
    COMMAND ${CMAKE_COMMAND} -DLOWER=${LOWER} -DFOLDER=${copy} -DWORK=${WORK}/${fault}/again
      "-DGENERATED=${GENERATED}" -P ${CMAKE_CURRENT_LIST_DIR}/generated_test.cmake
    RESULT_VARIABLE status ERROR_VARIABLE errors)
  if(status EQUAL 0 OR NOT errors MATCHES "${expected}")
    message(FATAL_ERROR "a wrong ${fault} was not seen:\n${errors}")
  endif()
endforeach()
