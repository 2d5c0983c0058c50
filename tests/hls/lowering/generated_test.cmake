# cmake -DLOWER=<emax_lower> -DFOLDER=<hls/rtl/generated> -DWORK=<folder>
#   "-DGENERATED=<file arguments...;...>" -P generated_test.cmake
# Lowers every generated file again and compares bytes; nothing else may lie beside them.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
set(names "")
foreach(entry ${GENERATED})
  separate_arguments(entry)
  list(POP_FRONT entry name)
  list(APPEND names ${name})
  execute_process(COMMAND ${LOWER} ${entry} -o ${WORK}/${name} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${WORK}/${name} ${FOLDER}/${name}
    RESULT_VARIABLE differs OUTPUT_QUIET ERROR_QUIET)
  if(differs)
    message(FATAL_ERROR "${FOLDER}/${name} is not what the kernel's source gives: "
      "run `ninja generate_rtl` in the build folder and commit the result")
  endif()
endforeach()
file(GLOB found RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT found)
list(SORT names)
if(NOT names OR NOT found STREQUAL names)
  message(FATAL_ERROR "${FOLDER} holds ${found}, but ${names} are generated")
endif()
