# Code in lanes of SIMD registers: `*_simd.cpp` is compiled once per level of numbers/simd.hpp, with that level's
# instructions, in the namespace of that level; which one runs is chosen when the program starts.

find_path(NOETHER_HIGHWAY_INCLUDE hwy/highway.h REQUIRED)

set(NOETHER_SIMD_LEVELS base)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND NOETHER_SIMD_LEVELS avx2 avx512)
endif()
set(NOETHER_SIMD_FLAGS_base)
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # As x86-64 has it at this level: no fused multiply-add, which NEON's lanes would use, and so the same bits.
  set(NOETHER_SIMD_FLAGS_base -DHWY_COMPILE_ONLY_SCALAR)
endif()
# Highway takes a processor for x86-64-v3 or v4 only if it also has these two.
set(NOETHER_SIMD_FLAGS_avx2 -march=x86-64-v3 -maes -mpclmul)
set(NOETHER_SIMD_FLAGS_avx512 -march=x86-64-v4 -maes -mpclmul)

# noether_simd(<target> [SUFFIX <text>] [OPTIONS <flag>...] SOURCES <file>...)
#
# Gives a target the objects of all levels; their namespaces are avx2<suffix> and so on.
function(noether_simd target)
  cmake_parse_arguments(PARSE_ARGV 1 simd "" "SUFFIX" "OPTIONS;SOURCES")
  foreach(level IN LISTS NOETHER_SIMD_LEVELS)
    set(objects ${target}_${level}${simd_SUFFIX})
    add_library(${objects} OBJECT ${simd_SOURCES})
    noether_warnings(${objects})
    target_compile_features(${objects} PRIVATE cxx_std_20)
    target_include_directories(${objects} PRIVATE ${PROJECT_SOURCE_DIR})
    target_include_directories(${objects} SYSTEM PRIVATE ${NOETHER_HIGHWAY_INCLUDE})
    # Highway's namespace is renamed too: what is not inlined must not stand in for the same function of another level.
    # Its assertions, which sanitizers switch on, would then call a function that no library has.
    target_compile_definitions(${objects} PRIVATE NOETHER_SIMD_LEVEL=${level}${simd_SUFFIX} HWY_IS_DEBUG_BUILD=0
                                                  hwy=hwy_${level}${simd_SUFFIX})
    target_compile_options(${objects} PRIVATE -ffp-contract=off ${NOETHER_SIMD_FLAGS_${level}} ${simd_OPTIONS}
      # Before registers are given out, g++ does not reorder on its own; several chains side by side want it to. Stores
      # of whole registers stay such, not a memset that writes them in parts.
      $<$<CXX_COMPILER_ID:GNU>:-fschedule-insns -fsched-pressure -fno-tree-loop-distribute-patterns>)
    # Sanitizers run everything else without optimization; here each lane's operation would be a call. (At the base
    # level there is one lane and nothing to gain, and clang takes minutes; so it does for kernels of constraints, of
    # which sanitized tests run few steps.)
    # At the level avx2 both sanitizers together take ten times as long to compile as each of them: there nothing is
    # watched, for the same sources are at the other levels.
    if(NOT level STREQUAL "base" AND NOT target STREQUAL "noether_constraints")
      target_compile_options(${objects} PRIVATE $<$<CONFIG:RelWithDebInfo>:-O1>)
    endif()
    if(level STREQUAL "avx2" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize=address,undefined")
      target_compile_options(${objects} PRIVATE -fno-sanitize=all)
    endif()
    if(NOETHER_FUZZ)  # as of the sources around them
      target_compile_options(${objects} PRIVATE -fno-sanitize=undefined)
    endif()
    # Kernels of constraints are large, and no processor of today runs those of the base level: there they take a third
    # of the time to compile.
    if(level STREQUAL "base" AND target STREQUAL "noether_constraints")
      target_compile_options(${objects} PRIVATE $<$<CONFIG:Release>:-O1>)
    endif()
    if(level STREQUAL "base" AND NOETHER_STATIC)  # a wheel is to be small
      target_compile_options(${objects} PRIVATE $<$<CONFIG:Release>:-Os>)
    endif()
    set_target_properties(${objects} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${objects}>)
  endforeach()
endfunction()
