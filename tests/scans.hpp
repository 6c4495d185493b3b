// Real scans for the slow tests: meshes of Debian's package libcgal-demo, which the build unpacks.
#pragma once

#include <filesystem>
#include <string>

namespace scan2fea {

// One of the files that tests/CMakeLists.txt lists.
inline std::filesystem::path scan(const std::string& name) {
  return std::filesystem::path(SCAN2FEA_SCANS) / name;
}

}  // namespace scan2fea
