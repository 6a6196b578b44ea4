# Packages: `cpack -G DEB` in a build folder makes noether_VERSION_ARCHITECTURE.deb, the program with its manual, examples
# and documents, and noether-dev_VERSION_ARCHITECTURE.deb, libraries and headers for programs of one's own.
# tests/package installs both on a bare system.
if(NOT PROJECT_IS_TOP_LEVEL OR NOT TARGET noether)
  return()
endif()

set(documents ${CMAKE_INSTALL_DATADIR}/doc/noether)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CITATION.cff DESTINATION ${documents}
        COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/third_party/pocketfft/LICENSE.md DESTINATION ${documents} RENAME pocketfft-LICENSE.md
        COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${documents} COMPONENT program
        PATTERN "nightly.md" EXCLUDE)
# Not what runs have left there.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${documents} COMPONENT program
        PATTERN "*.out" EXCLUDE PATTERN "*.out.[0-9]*" EXCLUDE PATTERN "run.h5" EXCLUDE
        REGEX "/examples/CMakeLists\\.txt$" EXCLUDE)

# The manual page is the program's own help, and the change log and licence have the names that Debian gives them.
foreach(component program library)
  install(CODE "execute_process(COMMAND \"${CMAKE_COMMAND}\" -DCOMPONENT=${component} -DVERSION=${PROJECT_VERSION}
    \"-DPROGRAM=$<TARGET_FILE:noether>\" \"-DSOURCE_DIR=${PROJECT_SOURCE_DIR}\" -DDATA=${CMAKE_INSTALL_DATADIR}
    \"-DPREFIX=\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\"
    -P \"${PROJECT_SOURCE_DIR}/cmake/write_documents.cmake\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT ${component})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME noether)
set(CPACK_PACKAGE_VENDOR "The noether developers")
set(CPACK_PACKAGE_CONTACT "The noether developers <noether@users.noreply.github.com>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "N-body and molecular dynamics on symplectic integrators")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program library)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME noether)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS noether-dev)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"Integrates orbits, molecules and systems of ordinary differential equations
that are described in scene files, and reports what a run conserved: energy,
momentum and angular momentum, with their errors and drifts. The same scene
gives the same bits on any number of threads and across a restart.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME noether-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
# What cmake/noetherConfig.cmake.in looks for, and a compiler. toml++, CLI11 and Highway are in no installed header.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS
    "g++, cmake (>= 3.25), libeigen3-dev (>= 3.4), libfmt-dev, libssl-dev, zlib1g-dev")
if(NOETHER_HDF5)
  string(APPEND CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS ", libhdf5-dev")
endif()
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS noether)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION
"Static libraries and C++ headers of noether, for programs with forces,
constraints, monitors or systems of their own: find_package(noether) in CMake.")
include(CPack)
