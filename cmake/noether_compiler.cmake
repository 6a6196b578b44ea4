# Compiler, launcher and the libraries noether stands on.

if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  set(CMAKE_CXX_EXTENSIONS OFF)
  if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release or RelWithDebInfo" FORCE)
  endif()
  # ccache looks through precompiled headers only if it is told that their time stamps do not matter.
  find_program(NOETHER_CCACHE ccache)
  if(NOETHER_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
        CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime ${NOETHER_CCACHE})
  endif()
endif()

set(NOETHER_FMT_TARGET fmt::fmt)
if(NOETHER_STATIC)
  set(NOETHER_FMT_TARGET fmt::fmt-header-only)
  set(HDF5_USE_STATIC_LIBRARIES ON)
  set(OPENSSL_USE_STATIC_LIBS ON)
endif()

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt 9 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(CLI11 REQUIRED)
find_package(Threads REQUIRED)

set(NOETHER_OPENMP_TARGET)
if(NOETHER_OPENMP)
  find_package(OpenMP REQUIRED COMPONENTS CXX)
  set(NOETHER_OPENMP_TARGET OpenMP::OpenMP_CXX)
endif()

set(NOETHER_HDF5_TARGET)
if(NOETHER_HDF5)
  find_package(HDF5 1.10 REQUIRED COMPONENTS C)
  set(NOETHER_HDF5_TARGET hdf5::hdf5)
endif()

# toml++ is used header only and only inside scene/*.cpp: no installed file mentions it.
find_path(NOETHER_TOML_INCLUDE toml++/toml.h REQUIRED)
add_library(noether_toml INTERFACE)
target_include_directories(noether_toml SYSTEM INTERFACE ${NOETHER_TOML_INCLUDE})
target_compile_definitions(noether_toml INTERFACE TOML_HEADER_ONLY=1)

# The 113-bit type: __float128 with libquadmath where the compiler has it, long double elsewhere.
include(CheckCXXSourceCompiles)
set(CMAKE_REQUIRED_LIBRARIES quadmath)
check_cxx_source_compiles("extern \"C\" __float128 sqrtq(__float128);
  int main(int n, char**) { return static_cast<int>(sqrtq(static_cast<__float128>(n))); }" NOETHER_HAS_QUADMATH)
unset(CMAKE_REQUIRED_LIBRARIES)
set(NOETHER_QUADMATH)
if(NOETHER_HAS_QUADMATH)
  set(NOETHER_QUADMATH quadmath)
endif()

# What decides bits, for noether and for everyone who includes its headers: no contraction of a * b + c.
add_library(noether_options INTERFACE)
add_library(noether::options ALIAS noether_options)
set_target_properties(noether_options PROPERTIES EXPORT_NAME options)
target_compile_features(noether_options INTERFACE cxx_std_20)
target_compile_options(noether_options INTERFACE -ffp-contract=off)
# Changes no value: nobody asks for the processor's floating point exceptions, and g++ turns loops with choices into lanes
# only where it need not keep them. Pair potentials of users are such loops.
target_compile_options(noether_options INTERFACE -fno-trapping-math)
# Eigen's alignment is part of the binary interface; without these it would follow the consumer's -march.
target_compile_definitions(noether_options INTERFACE EIGEN_MAX_ALIGN_BYTES=64 EIGEN_MAX_STATIC_ALIGN_BYTES=16)
# Eigen's own threads wait awake for each other: beside other programs a factorization took many times as long on two as
# on one.
target_compile_definitions(noether_options INTERFACE EIGEN_DONT_PARALLELIZE)
# HDF5's own list of libraries brings curl and others along; only what is used is loaded.
target_link_options(noether_options INTERFACE LINKER:--as-needed)
if(NOT NOETHER_OPENMP)
  target_compile_options(noether_options INTERFACE -Wno-unknown-pragmas)
endif()

# Warnings are ours, never a consumer's. Square roots need no errno; that changes no bit.
function(noether_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -fno-math-errno
                                           $<$<BOOL:${NOETHER_WERROR}>:-Werror>)
  # g++ 12 takes the sum of two strings for an overlapping or endless copy (GCC bugs 105329 and 105651).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-stringop-overflow)
  endif()
  # g++ must keep the name of the precompiled header in preprocessed text, or ccache cannot use it.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -fpch-preprocess)
  elseif(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    target_compile_options(${target} PRIVATE "SHELL:-Xclang -fno-pch-timestamp")
  endif()
endfunction()

# Compiles the sources of a target several at a time, so that headers and templates are met once for all of them; at
# most MOST of them, where that is given.
function(noether_unity target)
  cmake_parse_arguments(ARG "" "MOST" "" ${ARGN})
  if(NOETHER_UNITY)
    set(batch ${NOETHER_UNITY})
    if(batch STREQUAL "ON")
      set(batch 4)  # in build folders of before this was a number
    elseif(batch STREQUAL "ROOM")
      set(batch 0)  # to CMake that is all
    elseif(NOT batch MATCHES "^[1-9][0-9]*$")
      message(FATAL_ERROR "NOETHER_UNITY is ${NOETHER_UNITY}; a number of sources is expected, ROOM or OFF")
    endif()
    if(ARG_MOST AND (batch EQUAL 0 OR batch GREATER ARG_MOST))
      set(batch ${ARG_MOST})
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${batch})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-subobject-linkage)  # g++ takes each of them for a header
      if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)  # the same two bugs, met where more is inlined
        target_compile_options(${target} PRIVATE -Wno-array-bounds)
      endif()
    endif()
  endif()
endfunction()
