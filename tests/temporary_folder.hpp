// A folder that lives as long as a test, and files in it written and read whole.
#pragma once

#include "preproc/mesh/temporary_folder.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace scan2fea {

inline std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Returns the path. A file that is truncated and written again is flushed to the disk by some file systems when it is
// closed; one that is removed first is not, which makes tests of many files fast.
inline std::filesystem::path write_text(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::remove(file);
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

}  // namespace scan2fea
