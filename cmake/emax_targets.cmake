# How every target of the project is made: its flags, and the include path that enforces the
# direction of dependence (hls -> sw_model -> testbench -> host). A room's headers are reached as
# "<folder>/..." through a folder that holds a link to that room alone, so a target sees a room only
# when it links the room's library.

option(EMAX_UNITY "Compile the sources of a target several at a time, which takes less time" ON)

# emax_alone(<source>...): sources of this folder that no others are compiled with.
function(emax_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# emax_faulty_alone(<source>...): those of them that hold deliberate faults, with which tests and fuzz
# targets have them a second time. They are alone in every build, so that the others are always
# together with the same ones.
function(emax_faulty_alone)
  foreach(source ${ARGN})
    get_filename_component(path ${source} ABSOLUTE)
    if(EXISTS ${path})  # others are made by the build
      file(STRINGS ${path} holds REGEX "deliberate_fault\\.h" LIMIT_COUNT 1)
      if(holds)
        emax_alone(${source})
      endif()
    endif()
  endforeach()
endfunction()

function(emax_flags target)
  # Most of the time goes to the templates of Eigen and GoogleTest, which the sources have in common.
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${EMAX_UNITY} UNITY_BUILD_BATCH_SIZE 10)
  if(EMAX_UNITY)  # the compiler takes the sources for headers, where this warning would be right
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
  # No contraction anywhere: the numeric contract counts every rounding (docs/numerics.md).
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wconversion -Wshadow -Werror -ffp-contract=off)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # GCC 12 sees overlap in std::string's operator+ where there is none (GCC bug 105651).
    target_compile_options(${target} PRIVATE -Wno-restrict)
    # Its SLP vectoriser turns pairs of double -> float -> double into plain copies and so drops
    # roundings that the numeric contract counts; the tests of storing to STL show it.
    target_compile_options(${target} PRIVATE -fno-tree-slp-vectorize)
  endif()
  if(EMAX_SANITIZE)
    target_compile_options(${target} PRIVATE
      -g1 -fsanitize=${EMAX_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PRIVATE -fsanitize=${EMAX_SANITIZE})
    if(EMAX_SANITIZE MATCHES "address|thread")  # they reserve terabytes that they never touch
      target_compile_definitions(${target} PRIVATE EMAX_UNLIMITED_ADDRESS_SPACE)
    endif()
    # In what a sanitizer added GCC 12 sees reads of variables that are not set.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    # Under the address sanitizer Eigen would pad what it allocates, and the packaged PCL does not.
    target_compile_definitions(${target} PRIVATE EIGEN_MALLOC_ALREADY_ALIGNED=1)
  endif()
  # PCL's packages name libraries that nothing here calls. Debian's GCC leaves those out unasked.
  target_link_options(${target} PRIVATE -Wl,--as-needed)
  if(EMAX_COVERAGE)
    target_compile_options(${target} PRIVATE -fprofile-instr-generate -fcoverage-mapping)
    target_link_options(${target} PRIVATE -fprofile-instr-generate)
  endif()
endfunction()

# emax_compile_quickly(<target>): for code whose speed nobody notices. In Release it takes two thirds
# of the time that -O3 takes to compile.
function(emax_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# emax_export_room(<target> <scope> <room>): lets users of <target> include "<room>/...", and the
# room's public headers, those in its folder emax/, as <emax/...>, as they are installed.
function(emax_export_room target scope room)
  string(REPLACE "/" "." flat ${room})
  set(view ${PROJECT_BINARY_DIR}/include/${flat})
  get_filename_component(parent ${view}/${room} DIRECTORY)
  file(MAKE_DIRECTORY ${parent})
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${room} ${view}/${room} SYMBOLIC)
  target_include_directories(${target} ${scope} ${view})
  file(GLOB public CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${room}/emax/*.h)
  foreach(header ${public})
    get_filename_component(name ${header} NAME)
    file(MAKE_DIRECTORY ${view}.public/emax)
    file(CREATE_LINK ${header} ${view}.public/emax/${name} SYMBOLIC)
    target_include_directories(${target} ${scope} ${view}.public)
  endforeach()
endfunction()

# emax_library(<target> SOURCES ... LINKS ... PRIVATE_LINKS ... [VARIANT]): the library of the folder
# whose CMakeLists.txt calls. It links only what stands before it, so that the order of the
# CMakeLists.txt is that of dependence. A folder is one library; VARIANT marks one of several that
# stand for each other behind the same headers (the design as it is, with faults, with counters).
function(emax_library target)
  cmake_parse_arguments(ARG "VARIANT" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  file(RELATIVE_PATH room ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  get_property(owner GLOBAL PROPERTY EMAX_LIBRARY_OF_${room})
  if(owner AND NOT ARG_VARIANT)
    message(FATAL_ERROR "${target}: ${room} is the room of ${owner}, and a room is one library")
  endif()
  if(NOT ARG_VARIANT)
    set_property(GLOBAL PROPERTY EMAX_LIBRARY_OF_${room} ${target})
  endif()
  foreach(link ${ARG_LINKS} ${ARG_PRIVATE_LINKS})
    if(link MATCHES "^emax_")
      if(NOT TARGET ${link})
        message(FATAL_ERROR "${target} links ${link}, which no room before it defines")
      endif()
      set_property(GLOBAL APPEND PROPERTY EMAX_LINKS "${room} ${link}")
    endif()
  endforeach()
  set_property(GLOBAL APPEND PROPERTY EMAX_LIBRARIES "${room} ${target}")
  if(ARG_SOURCES)
    emax_faulty_alone(${ARG_SOURCES})
    add_library(${target} STATIC ${ARG_SOURCES})
    emax_flags(${target})
    emax_export_room(${target} PUBLIC ${room})
    target_link_libraries(${target} PUBLIC ${ARG_LINKS} PRIVATE ${ARG_PRIVATE_LINKS})
  else()
    add_library(${target} INTERFACE)
    emax_export_room(${target} INTERFACE ${room})
    target_link_libraries(${target} INTERFACE ${ARG_LINKS})
  endif()
endfunction()

# emax_test(<name> [THREADS] SOURCES ... LINKS ... [FAULTS <source>...] [TIMEOUT <seconds>]
#           [SLOW <test>...])
# One GoogleTest program, one ctest entry a test. FAULTS names sources of the product, from the root, that
# have an EMAX_FAULT (sw_model/base/deliberate_fault.h): a second program has them with their faults,
# and the tests of suites "...Fault" run there. THREADS marks a program with threads; ./dev test tsan
# runs it. SLOW names the tests, as GoogleTest filters them, that ./dev test fast leaves out: those of
# more than three seconds.
function(emax_test name)
  cmake_parse_arguments(ARG "THREADS" "TIMEOUT" "SOURCES;LINKS;FAULTS;SLOW" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  if(EMAX_COVERAGE OR EMAX_SANITIZE)  # counting and checking take several times as long
    math(EXPR ARG_TIMEOUT "6 * ${ARG_TIMEOUT}")
  endif()
  add_executable(${name} ${ARG_SOURCES})
  emax_flags(${name})
  emax_compile_quickly(${name})
  # Clang's -Wconversion has the change of a sign too, as of a list {1, 4} of sizes.
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>)
  target_link_libraries(${name} PRIVATE ${ARG_LINKS} GTest::gtest_main)
  set(properties PROPERTIES TIMEOUT ${ARG_TIMEOUT})
  if(EMAX_SANITIZE MATCHES "address")
    list(APPEND properties ENVIRONMENT
      "LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/cmake/leaks_of_libraries.txt:print_suppressions=0")
  endif()
  if(ARG_THREADS)
    list(APPEND properties LABELS threads)
    add_dependencies(emax_threads_tests ${name})
  endif()
  set(left_out ${ARG_SLOW})
  if(ARG_FAULTS)
    list(TRANSFORM ARG_FAULTS PREPEND ${PROJECT_SOURCE_DIR}/)
    add_library(${name}_broken OBJECT ${ARG_FAULTS})
    emax_flags(${name}_broken)
    target_compile_definitions(${name}_broken PRIVATE EMAX_DELIBERATE_FAULTS)
    target_link_libraries(${name}_broken PRIVATE ${ARG_LINKS})
    add_executable(${name}_faults $<TARGET_OBJECTS:${name}> $<TARGET_OBJECTS:${name}_broken>)
    emax_flags(${name}_faults)
    target_link_libraries(${name}_faults PRIVATE ${ARG_LINKS} GTest::gtest_main)
    gtest_discover_tests(${name}_faults TEST_FILTER *Fault.* DISCOVERY_TIMEOUT 120 ${properties})
    if(ARG_THREADS)
      add_dependencies(emax_threads_tests ${name}_faults)
    endif()
    list(APPEND left_out *Fault.*)
  endif()
  set(filter)
  if(left_out)
    list(JOIN left_out ":" left_out)
    set(filter TEST_FILTER -${left_out})
  endif()
  gtest_discover_tests(${name} ${filter} DISCOVERY_TIMEOUT 120 ${properties})
  if(ARG_SLOW)
    list(JOIN ARG_SLOW ":" slow)
    gtest_discover_tests(${name} TEST_FILTER ${slow} TEST_LIST ${name}_slow_TESTS DISCOVERY_TIMEOUT 120
      ${properties} LABELS slow)
  endif()
endfunction()

# emax_slow(<test>...): marks other tests of this folder as slow.
function(emax_slow)
  set_property(TEST ${ARGN} APPEND PROPERTY LABELS slow)
endfunction()

# emax_list_rooms(<file>): writes a line for each library, "<room> <library>", and one for each link
# between libraries, "<room> uses <library>".
function(emax_list_rooms file)
  get_property(libraries GLOBAL PROPERTY EMAX_LIBRARIES)
  get_property(links GLOBAL PROPERTY EMAX_LINKS)
  list(TRANSFORM links REPLACE " " " uses ")
  list(JOIN libraries "\n" libraries)
  list(JOIN links "\n" links)
  file(WRITE ${file} "${libraries}\n${links}\n")
endfunction()
