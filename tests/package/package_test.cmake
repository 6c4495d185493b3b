# Installs the project, uses it from another one, moves the installation, and uses it again where it lies then:
#
#   cmake -D BUILD=the build folder -D FOLDER=for all that is made here -D SCAN=a surface -D VERSION=the project's
#     -D CONFIG=Release -D GENERATOR=Ninja -D COMPILER=... -D FLAGS=... -D LAUNCHER=... -P package_test.cmake
#
# FOLDER is emptied first. It is always the same one, so that a compiler cache finds the headers of the last run.
cmake_minimum_required(VERSION 3.25)

set(installed ${FOLDER}/installed)
set(moved ${FOLDER}/somewhere/else)

# Sets `output` to what the command prints; the test ends where it fails.
macro(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE errors RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    string(REPLACE ";" " " command "${ARGN}")
    message(FATAL_ERROR "${command}\nended with ${status}\n${output}${errors}")
  endif()
endmacro()

# A mesh by TetGen's worker.
function(expect_meshes program)
  foreach(mesh part.inp part.msh)
    file(REMOVE ${FOLDER}/${mesh})
    run(${program} ${SCAN} ${FOLDER}/${mesh})
    if(NOT output MATCHES "^scan2fea ${VERSION}: [1-9][0-9]* tetrahedra\n$" OR NOT EXISTS ${FOLDER}/${mesh})
      message(FATAL_ERROR "${program} made no ${mesh}: ${output}")
    endif()
  endforeach()
endfunction()

function(build_program prefix folder)
  run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${CMAKE_CURRENT_LIST_DIR} -B ${folder} -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_BUILD_TYPE=${CONFIG} -D CMAKE_CXX_COMPILER=${COMPILER} -D "CMAKE_CXX_FLAGS=${FLAGS}"
    -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
  run(${CMAKE_COMMAND} --build ${folder})
endfunction()

function(expect_the_command prefix)
  run(${prefix}/bin/scan2fea --version)
  if(NOT output MATCHES "^scan2fea ${VERSION}\n")
    message(FATAL_ERROR "scan2fea --version prints ${output} and the package is of version ${VERSION}")
  endif()
  foreach(mesh part.inp part.msh)
    run(${prefix}/bin/scan2fea run ${SCAN} -o ${FOLDER}/${mesh} --faces 1000 --force --quiet)
  endforeach()
endfunction()

set(ENV{CCACHE_SLOPPINESS} pch_defines,time_macros)  # without, it keeps nothing that uses a precompiled header
file(REMOVE_RECURSE ${FOLDER})
run(${CMAKE_COMMAND} --install ${BUILD} --config ${CONFIG} --prefix ${installed})
build_program(${installed} ${FOLDER}/program)
run(${CMAKE_COMMAND} --build ${FOLDER}/program --target headers_alone)
expect_meshes(${FOLDER}/program/scan_to_mesh)

file(MAKE_DIRECTORY ${FOLDER}/somewhere)
file(RENAME ${installed} ${moved})
build_program(${moved} ${FOLDER}/program_of_moved)
expect_meshes(${FOLDER}/program_of_moved/scan_to_mesh)
expect_the_command(${moved})
