# version.cpp defines noether::version() and noether::commit(). The target noether_commit asks git at every build and
# rewrites the file only if the answer has changed, so that moving HEAD costs one small file and the links.
set(NOETHER_VERSION_SOURCE ${PROJECT_BINARY_DIR}/version.cpp)
set(version_command ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
    -DTEMPLATE=${PROJECT_SOURCE_DIR}/cmake/version.cpp.in -DOUTPUT=${NOETHER_VERSION_SOURCE}
    -P ${PROJECT_SOURCE_DIR}/cmake/write_version.cmake)
execute_process(COMMAND ${version_command})
add_custom_target(noether_commit COMMAND ${version_command} BYPRODUCTS ${NOETHER_VERSION_SOURCE}
                  COMMENT "Checking the commit" VERBATIM)
