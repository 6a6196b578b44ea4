# Installs headers below include/noether/<folder>, one library per folder, and a package with one component per folder,
# so that a program that links only the engine needs neither HDF5 nor OpenSSL.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/noether)

# Two components, which become two packages: `library`, for who writes programs, and `program`.
install(TARGETS noether_options EXPORT noether-options COMPONENT library)
install(EXPORT noether-options NAMESPACE noether:: DESTINATION ${package_folder} COMPONENT library)

foreach(room IN LISTS NOETHER_ROOMS)
  install(TARGETS noether_${room} EXPORT noether-${room}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library)
  install(EXPORT noether-${room} NAMESPACE noether:: DESTINATION ${package_folder} COMPONENT library)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room} DESTINATION include/noether COMPONENT library
          FILES_MATCHING PATTERN "*.hpp" PATTERN "*_simd.hpp" EXCLUDE)
endforeach()

install(FILES ${PROJECT_SOURCE_DIR}/noether.hpp DESTINATION include/noether COMPONENT library)

# The scenes of `noether stability --suite`.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/study/suite DESTINATION ${CMAKE_INSTALL_DATADIR}/noether COMPONENT program)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/noetherConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/noetherConfig.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/noetherConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/noetherConfig.cmake ${PROJECT_BINARY_DIR}/noetherConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT library)
