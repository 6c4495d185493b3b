#include "preproc/mesh/file_extension.hpp"

#include <algorithm>

namespace scan2fea {

std::string lower_case_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

std::string extension_of_content(const std::filesystem::path& file) {
  const std::string extension = lower_case_extension(file);
  return extension == ".gz" ? lower_case_extension(file.stem()) : extension;
}

}  // namespace scan2fea
