# view_files.cpp holds the files of cli/view/ as text, so that `noether view` makes a page that needs nothing else.
find_package(ZLIB REQUIRED)  # pages compress their frames

set(NOETHER_VIEW_SOURCE ${PROJECT_BINARY_DIR}/view_files.cpp)

function(noether_read_view variable)
  set(text "")
  foreach(name IN LISTS ARGN)
    set(file ${PROJECT_SOURCE_DIR}/cli/view/${name})
    set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    file(READ ${file} content)
    string(APPEND text "${content}")
  endforeach()
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

noether_read_view(NOETHER_VIEW_PAGE page.html)
noether_read_view(NOETHER_VIEW_STYLE view.css)
noether_read_view(NOETHER_VIEW_SCRIPT motion.js picture.js look.js view.js controls.js)
configure_file(${PROJECT_SOURCE_DIR}/cmake/view_files.cpp.in ${NOETHER_VIEW_SOURCE} @ONLY)
