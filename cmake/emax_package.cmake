# What other projects link: libemax, static and shared, its headers, its packages.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# The rooms that the public headers need. Their objects are compiled once.
set(rooms emax_base emax_model emax_certify emax_protocol emax_simd emax_geometry emax_surface
  emax_features emax_decimate emax_engine emax_block_search emax_measure emax_genocop)
set(objects)
foreach(room ${rooms})
  list(APPEND objects $<TARGET_OBJECTS:${room}>)
endforeach()
find_package(fmt REQUIRED)
find_package(hwy REQUIRED)
find_package(Threads REQUIRED)
foreach(kind STATIC SHARED)
  string(TOLOWER emax_${kind} target)
  add_library(${target} ${kind} ${objects})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME emax VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} LINKER_LANGUAGE CXX)
  target_link_libraries(${target} PRIVATE fmt::fmt hwy::hwy Threads::Threads)
endforeach()
set_target_properties(emax_static emax_shared PROPERTIES ARCHIVE_OUTPUT_DIRECTORY
  ${PROJECT_BINARY_DIR}/lib LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)

install(TARGETS emax_static emax_shared)
install(TARGETS emax)
if(EMAX_WORKERS)
  install(TARGETS emax_worker)
  if(EMAX_MPI)
    install(TARGETS emax_mpi)
  endif()
endif()

# <emax/...>, and what those of kernel and arithmetic include, as it stands in the project.
set(headers ${CMAKE_INSTALL_INCLUDEDIR}/emax)
file(GLOB public CONFIGURE_DEPENDS hls/*/emax/*.h sw_model/*/emax/*.h host/*/emax/*.h)
install(FILES ${public} DESTINATION ${headers})
install(DIRECTORY hls/kernel DESTINATION ${headers}/hls
  FILES_MATCHING PATTERN "*.h" PATTERN "*/emax" EXCLUDE)
install(FILES hls/kernel/emax_top.cpp DESTINATION ${headers}/hls/kernel)
install(FILES sw_model/base/float_bits.h sw_model/base/flush_mode.h
  DESTINATION ${headers}/sw_model/base)
install(FILES sw_model/model/arithmetic_probe.h sw_model/model/emax_model.h sw_model/model/probe_pairs.h
  DESTINATION ${headers}/sw_model/model)
# The element's SystemVerilog for a design of one's own.
install(DIRECTORY hls/rtl DESTINATION ${CMAKE_INSTALL_DATADIR}/emax
  FILES_MATCHING PATTERN "*.sv" PATTERN "*.svh" PATTERN "*.f")
file(GLOB documents CONFIGURE_DEPENDS docs/*.md)
set(of_no_command docs/user/large-scans.md docs/user/lowering.md docs/user/mpi.md docs/user/python.md docs/user/report.md)
install(FILES LICENSE ${documents} ${of_no_command} DESTINATION ${CMAKE_INSTALL_DOCDIR})

# A manual page for emax and one for each command, of the program's own --help and of docs/user/.
if(EMAX_MAN)
  find_program(LOWDOWN lowdown REQUIRED)
  file(GLOB documents CONFIGURE_DEPENDS docs/user/*.md)
  foreach(document ${of_no_command})
    list(REMOVE_ITEM documents ${PROJECT_SOURCE_DIR}/${document})
  endforeach()
  foreach(document ${documents})
    get_filename_component(command ${document} NAME_WE)
    set(page emax-${command})
    if(command STREQUAL files)
      set(command)
      set(page emax)
    endif()
    string(TOUPPER ${page} title)
    set(output ${PROJECT_BINARY_DIR}/man/${page})
    add_custom_command(OUTPUT ${output}.1
      COMMAND ${PROJECT_SOURCE_DIR}/cmake/man_page.sh $<TARGET_FILE:emax> ${PROJECT_SOURCE_DIR}/docs
        ${CMAKE_INSTALL_DOCDIR} ${command} > ${output}.md
      COMMAND ${LOWDOWN} -s -tman --out-no-smarty -m title=${title} -m section=1
        -m "source=emax ${PROJECT_VERSION}" -o ${output}.1 ${output}.md
      DEPENDS emax cmake/man_page.sh ${document} COMMENT "Manual page ${page}(1)")
    list(APPEND pages ${output}.1)
  endforeach()
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/man)
  add_custom_target(emax_man ALL DEPENDS ${pages})
  install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
endif()

# Where each shell looks for completions by itself.
set(completions ${PROJECT_BINARY_DIR}/completions)
file(MAKE_DIRECTORY ${completions})
add_custom_command(OUTPUT ${completions}/emax.bash ${completions}/emax.zsh ${completions}/emax.fish
  COMMAND emax completion bash > ${completions}/emax.bash
  COMMAND emax completion zsh > ${completions}/emax.zsh
  COMMAND emax completion fish > ${completions}/emax.fish
  DEPENDS emax COMMENT "Completions for shells")
add_custom_target(emax_completions ALL DEPENDS ${completions}/emax.bash)
install(FILES ${completions}/emax.bash RENAME emax
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${completions}/emax.zsh RENAME _emax
  DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
install(FILES ${completions}/emax.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/emax)
configure_package_config_file(cmake/emaxConfig.cmake.in
  ${PROJECT_BINARY_DIR}/package/emaxConfig.cmake INSTALL_DESTINATION ${package}
  PATH_VARS CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_DATADIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/package/emaxConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/package/emaxConfig.cmake
  ${PROJECT_BINARY_DIR}/package/emaxConfigVersion.cmake DESTINATION ${package})

configure_file(cmake/emax.pc.in ${PROJECT_BINARY_DIR}/package/emax.pc @ONLY)
configure_file(cmake/emax-kernel.pc.in ${PROJECT_BINARY_DIR}/package/emax-kernel.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/package/emax.pc ${PROJECT_BINARY_DIR}/package/emax-kernel.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# `cpack` makes emax_VERSION_ARCHITECTURE.deb.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The developers of emax")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY
  "Meshes of laser scans with as few triangles as possible under a certified maximum error")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
