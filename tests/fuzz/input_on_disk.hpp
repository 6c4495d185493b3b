// The bytes of one run as a file, since readers take files. Its folder lives as long as the process.
#pragma once

#include "tests/temporary_folder.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace scan2fea::fuzz {

inline std::filesystem::path input_on_disk(const std::string& name, const std::uint8_t* data, std::size_t size) {
  static const TemporaryFolder folder;
  return write_text(folder / name, {reinterpret_cast<const char*>(data), size});
}

}  // namespace scan2fea::fuzz
