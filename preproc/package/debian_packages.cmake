# Debian packages of what is installed, in build/release/packages: cmake --build build/release --target packages
#
#   scan2fea           the command, the library, and what both start or load at run time
#   libscan2fea-dev    headers and the CMake package
#   python3-scan2fea   the Python module
#
# What they link is found by dpkg-shlibdeps; the dependencies below are of what it does not see.
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT "The makers of scan2fea")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # the tests need not be built
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(same_version "scan2fea (= ${PROJECT_VERSION})")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME scan2fea)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "The command and the library: repairs and simplifies a scan, fills it with
tetrahedra, and writes files of CalculiX, Abaqus, Nastran, Code_Aster, DOLFINx
and others.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS libfreetype6)  # opened by pictures
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "calculix-ccx, chromium")  # the solver of the decks; reports as PDF

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libscan2fea-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Headers and CMake package of the library.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${same_version}, libeigen3-dev, nlohmann-json3-dev")

if(TARGET scan2fea_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-scan2fea)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "The Python module: the sub-commands as functions of NumPy arrays.")
  get_directory_property(python_minor DIRECTORY preproc/python DEFINITION Python3_VERSION_MINOR)
  math(EXPR next_python_minor "${python_minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "${same_version}, python3-numpy, python3 (>= 3.${python_minor}), python3 (<< 3.${next_python_minor})")
endif()

include(CPack)
add_custom_target(packages VERBATIM USES_TERMINAL
  COMMAND ${CMAKE_CPACK_COMMAND} --config ${PROJECT_BINARY_DIR}/CPackConfig.cmake)
add_dependencies(packages scan2fea libscan2fea scan2fea-tetgen scan2fea-med)
if(TARGET scan2fea_python)
  add_dependencies(packages scan2fea_python)
endif()
