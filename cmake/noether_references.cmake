# references.cpp holds docs/references.bib as text, so that `noether describe` can print the entry of a source.
set(NOETHER_REFERENCES_SOURCE ${PROJECT_BINARY_DIR}/references.cpp)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/references.bib)
file(READ ${PROJECT_SOURCE_DIR}/docs/references.bib NOETHER_REFERENCES)
configure_file(${PROJECT_SOURCE_DIR}/cmake/references.cpp.in ${NOETHER_REFERENCES_SOURCE} @ONLY)
