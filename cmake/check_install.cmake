# Script: installs BUILD_DIR into a scratch prefix, then builds and runs programs against it from outside.
set(scratch ${BUILD_DIR}/check_install)
set(prefix ${scratch}/prefix)
file(REMOVE_RECURSE ${scratch})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}: exit ${status}\n${output}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})

# One consumer per component: it asks for that folder alone and includes all of that folder's headers.
# -march=native on purpose: the binary interface must not follow the consumer's instruction set.
foreach(room IN LISTS ROOMS)
  set(folder ${scratch}/${room})
  file(GLOB_RECURSE headers RELATIVE ${prefix}/include/noether ${prefix}/include/noether/${room}/*.hpp)
  set(includes "#include \"engine/version.hpp\"\n")
  foreach(header IN LISTS headers)
    string(APPEND includes "#include \"${header}\"\n")
  endforeach()
  file(WRITE ${folder}/main.cpp "${includes}int main() { return noether::version()[0] == '\\0'; }\n")
  file(WRITE ${folder}/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(consumer LANGUAGES CXX)
find_package(noether 0.1 REQUIRED COMPONENTS ${room})
add_executable(consumer main.cpp)
target_compile_options(consumer PRIVATE -march=native -Werror)
target_link_libraries(consumer PRIVATE noether::${room})
")
  run(${CMAKE_COMMAND} -S ${folder} -B ${folder}/build -G Ninja -DCMAKE_PREFIX_PATH=${prefix}
      -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS})
  run(${CMAKE_COMMAND} --build ${folder}/build)
  run(${folder}/build/consumer)
endforeach()

# Example projects of their own.
file(GLOB projects ${SOURCE_DIR}/examples/*/CMakeLists.txt)
foreach(project IN LISTS projects)
  cmake_path(GET project PARENT_PATH source)
  cmake_path(GET source FILENAME name)
  run(${CMAKE_COMMAND} -S ${source} -B ${scratch}/${name} -G Ninja -DCMAKE_PREFIX_PATH=${prefix}
      -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Release)
  run(${CMAKE_COMMAND} --build ${scratch}/${name})
endforeach()
