# find_package(scan2fea) gives the target scan2fea::scan2fea.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(nlohmann_json)
include("${CMAKE_CURRENT_LIST_DIR}/scan2fea-targets.cmake")
