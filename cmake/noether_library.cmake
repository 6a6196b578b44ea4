# noether_library(<folder> [SOURCES <file>...] [ROOMS <folder>...] [LINK <target>...] [LINK_PRIVATE <target>...]
#                 [EXCEPT <file>] [PRECOMPILE <header>... | PRECOMPILED_BY <folder>])
#
# The library noether::<folder> from <folder>/*.cpp (and one level of folders below) and SOURCES. A folder without sources is a
# header-only library, a folder that does not exist is none at all, and ROOMS that do not exist are passed over.
# <folder>/*_simd.cpp go through noether_simd, EXCEPT names a source that is no part of it.
# Without PRECOMPILE a folder shares the precompiled header of another one, by default that of numbers.

set(NOETHER_ROOMS "" CACHE INTERNAL "folders that became libraries, lowest layer first")

# Links the rooms that exist.
function(noether_link_rooms target scope)
  foreach(room IN LISTS ARGN)
    if(TARGET noether_${room})
      target_link_libraries(${target} ${scope} noether_${room})
    endif()
  endforeach()
endfunction()

# Of a wheel, the rooms, and the sources of others, whose own loops take the time of runs; the rest is small before it is quick.
# What is in lanes is compiled for speed everywhere.
set(rooms_of_loops numbers neighbors engine)
set(sources_of_loops composition free_rotor kepler kinetic_potential sphere_contacts wisdom_holman wisdom_holman_lanes)

# Of what computes, fuzzed scenes are watched for their addresses alone: with undefined behavior, which tests/asan watches,
# it takes twice as long to compile.
set(rooms_that_compute neighbors monitors forces constraints integrators)

function(noether_library folder)
  cmake_parse_arguments(PARSE_ARGV 1 library "" "EXCEPT;PRECOMPILED_BY" "SOURCES;ROOMS;LINK;LINK_PRIVATE;PRECOMPILE")
  set(root ${PROJECT_SOURCE_DIR}/${folder})
  file(GLOB sources CONFIGURE_DEPENDS ${root}/*.cpp ${root}/*/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS ${root}/*.hpp ${root}/*/*.hpp)
  if(library_EXCEPT)
    list(REMOVE_ITEM sources ${root}/${library_EXCEPT})
  endif()
  list(APPEND sources ${library_SOURCES})
  set(simd_sources ${sources})
  list(FILTER simd_sources INCLUDE REGEX "_simd\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "_simd\\.cpp$")
  if(NOT sources AND NOT headers)
    return()
  endif()

  set(target noether_${folder})
  set(scope PUBLIC)
  if(sources)
    add_library(${target} STATIC ${sources})
    noether_warnings(${target})
    target_link_libraries(${target} PRIVATE ${library_LINK_PRIVATE})
    if(NOETHER_PCH AND library_PRECOMPILE)
      target_precompile_headers(${target} PRIVATE ${library_PRECOMPILE})
    elseif(NOETHER_PCH)
      if(NOT library_PRECOMPILED_BY)
        set(library_PRECOMPILED_BY numbers)
      endif()
      target_precompile_headers(${target} REUSE_FROM noether_${library_PRECOMPILED_BY})
    endif()
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    noether_unity(${target})
    if(NOETHER_FUZZ AND folder IN_LIST rooms_that_compute)
      target_compile_options(${target} PRIVATE -fno-sanitize=undefined)
    endif()
    if(NOETHER_STATIC)  # a wheel is to be small, and -O3 makes twice the code of what is not in lanes
      if(folder IN_LIST rooms_of_loops)
        target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O2>)
      else()
        target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-Os>)
        foreach(source IN LISTS sources)
          cmake_path(GET source STEM name)
          if(name IN_LIST sources_of_loops)
            set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O2>)
          endif()
        endforeach()
      endif()
    endif()
    if(simd_sources)
      noether_simd(${target} SOURCES ${simd_sources})
    endif()
  else()
    set(scope INTERFACE)
    add_library(${target} INTERFACE)
  endif()
  add_library(noether::${folder} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${folder})
  target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                $<INSTALL_INTERFACE:include/noether>)
  target_link_libraries(${target} ${scope} noether_options ${library_LINK})
  noether_link_rooms(${target} ${scope} ${library_ROOMS})
  set(NOETHER_ROOMS ${NOETHER_ROOMS} ${folder} CACHE INTERNAL "")
endfunction()
