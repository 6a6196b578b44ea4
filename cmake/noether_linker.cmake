# Links by gold, with clang by lld, where they are: sixty programs in a third of the time. (With objects of g++ lld 14 leaves
# frames out of the table by which exceptions find their handlers.) Only what is built here; a consumer chooses its own.

if(PROJECT_IS_TOP_LEVEL)
  include(CheckLinkerFlag)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set(NOETHER_LINKER gold)
  else()
    set(NOETHER_LINKER lld)
  endif()
  check_linker_flag(CXX -fuse-ld=${NOETHER_LINKER} NOETHER_HAS_LINKER_${NOETHER_LINKER})
  if(NOETHER_HAS_LINKER_${NOETHER_LINKER})
    add_link_options(-fuse-ld=${NOETHER_LINKER})
  endif()
endif()
