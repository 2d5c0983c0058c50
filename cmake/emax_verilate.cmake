# How SystemVerilog becomes a C++ library.
find_package(verilator 5.006 HINTS $ENV{VERILATOR_ROOT})
if(NOT verilator_FOUND)
  message(FATAL_ERROR "Verilator is missing: run ./dev setup kernel")
endif()

# emax_verilated(<target> TOP <module> SOURCES <file>...
#                [PROBES] [TRACE] [COVERAGE] [MUTATION] [NATIVE] [PARAMETERS <name>=<value>...])
#
# A static library of the Verilated module: class V<target> in "V<target>.h". Sources are named from
# the root of the project. PROBES makes the values of all graph nodes readable, TRACE can write FST
# waveforms, COVERAGE counts, MUTATION builds the faults of hls/rtl/mutation.svh in, NATIVE takes
# this machine's instructions (a sixth faster; for programs that run only where they are built).
# Variants that differ in TRACE or COVERAGE belong in programs of their own: the runtime is compiled
# for one.
function(emax_verilated target)
  cmake_parse_arguments(ARG "PROBES;TRACE;COVERAGE;MUTATION;NATIVE" "TOP" "SOURCES;PARAMETERS" ${ARGN})
  list(TRANSFORM ARG_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/)
  # Undriven values are zero in two-state simulation, so that no run depends on chance.
  set(arguments -Wall -O3 -x-assign fast -x-initial fast +incdir+${PROJECT_SOURCE_DIR}/hls/rtl
                +incdir+${PROJECT_SOURCE_DIR}/hls/rtl/generated)
  foreach(parameter ${ARG_PARAMETERS})
    list(APPEND arguments -G${parameter})
  endforeach()
  foreach(macro PROBES MUTATION)
    if(ARG_${macro})
      list(APPEND arguments +define+EMAX_${macro})
    endif()
  endforeach()
  # The runtime's assertions check the contracts written in the modules.
  list(APPEND arguments --assert)
  set(options)
  if(ARG_TRACE)
    list(APPEND options TRACE_FST)
  endif()
  if(ARG_COVERAGE)
    list(APPEND options COVERAGE)
  endif()

  set(fast -O2)
  if(ARG_NATIVE)
    set(fast -O3 -march=native)
  endif()
  if(ARG_COVERAGE)
    set(fast -O1)
  endif()

  add_library(${target} STATIC)
  verilate(${target} ${options} PREFIX V${target} TOP_MODULE ${ARG_TOP} SOURCES ${ARG_SOURCES}
    VERILATOR_ARGS ${arguments} OPT_FAST ${fast} OPT_SLOW -O0)
  set_target_properties(${target} PROPERTIES SYSTEM ON)
  emax_share_runtime(${target})
endfunction()

# Verilator adds its runtime to every library; those that are alike in TRACE and COVERAGE share one,
# which prints only the first messages of failed assertions (testbench/verilator/verilator_messages.h).
function(emax_share_runtime target)
  set(library emax_verilator_runtime)
  set(macros)
  foreach(macro COVERAGE TRACE TRACE_FST)
    get_target_property(value ${target} VERILATOR_${macro})
    list(APPEND macros VM_${macro}=$<BOOL:${value}>)
    if(value)
      string(TOLOWER ${library}_${macro} library)
    endif()
  endforeach()

  get_target_property(sources ${target} SOURCES)
  set(runtime ${sources})
  list(FILTER runtime INCLUDE REGEX "/include/verilated[^/]*$")
  list(REMOVE_ITEM sources ${runtime})
  set_target_properties(${target} PROPERTIES SOURCES "${sources}")

  if(NOT TARGET ${library})
    add_library(${library} STATIC)
    target_include_directories(${library} SYSTEM PUBLIC
      ${VERILATOR_ROOT}/include ${VERILATOR_ROOT}/include/vltstd)
    # The headers ask for the same macros as the sources.
    target_compile_definitions(${library} PUBLIC ${macros} PRIVATE VM_SC=0)
    target_compile_options(${library} PRIVATE -O2)
    # What it prints is limited.
    set(messages ${PROJECT_SOURCE_DIR}/testbench/verilator/verilator_messages)
    target_sources(${library} PRIVATE ${messages}.cpp)
    emax_export_room(${library} PUBLIC testbench/verilator)
    target_compile_options(${library} PRIVATE -include ${messages}.h)
    target_compile_definitions(${library} PRIVATE VL_PRINTF=emax_verilator_printf)
    if(library MATCHES trace)
      find_package(ZLIB REQUIRED)
      target_link_libraries(${library} PUBLIC ZLIB::ZLIB)
    endif()
  endif()
  target_sources(${library} PRIVATE ${runtime})
  target_link_libraries(${target} PUBLIC ${library})
endfunction()
