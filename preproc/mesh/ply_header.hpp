// The header of a PLY file: what its body holds, and in which order.
#pragma once

#include "preproc/mesh/input_file.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace scan2fea {

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);
inline bool is_integer(PlyType type) {
  return type != PlyType::float32 && type != PlyType::float64;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count_type;  // of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  const char* declared_at = nullptr;  // in the file's bytes, for errors
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  const char* body = nullptr;  // the first byte behind the header
};

// Throws InvalidInput, naming the line, where the header is not one of PLY 1.0. What it promises is not checked here.
PlyHeader read_ply_header(const InputFile& file);

}  // namespace scan2fea
