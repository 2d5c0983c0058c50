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
    VERILATOR_ARGS ${arguments} OPT_FAST ${fast} OPT_SLOW -O0 OPT_GLOBAL -O2)
  set_target_properties(${target} PROPERTIES SYSTEM ON)
  # The headers ask for the same macros as the sources.
  foreach(macro COVERAGE TRACE TRACE_FST)
    target_compile_definitions(${target} INTERFACE
      VM_${macro}=$<BOOL:$<TARGET_PROPERTY:${target},VERILATOR_${macro}>>)
  endforeach()
  if(ARG_TRACE)
    find_package(ZLIB REQUIRED)
    target_link_libraries(${target} PUBLIC ZLIB::ZLIB)
  endif()
endfunction()
