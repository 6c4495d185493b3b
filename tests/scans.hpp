// Where the real scans lie that the slow tests read: in the folder that SCAN2FEA_DATA names, or beside the project.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace scan2fea {

// Nothing if this machine has no such scan; the test then skips and says so:
//   const auto file = find_scan("horse.ply");
//   if (!file) GTEST_SKIP() << "no scan horse.ply; set SCAN2FEA_DATA to the folder that has it";
inline std::optional<std::filesystem::path> find_scan(const std::string& name) {
  const char* folder = std::getenv("SCAN2FEA_DATA");
  const auto file = std::filesystem::path(folder != nullptr ? folder : SCAN2FEA_DEFAULT_DATA) / name;
  return std::filesystem::exists(file) ? std::optional(file) : std::nullopt;
}

}  // namespace scan2fea
