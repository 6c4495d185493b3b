// Binary files of point clouds, for tests and as seeds of fuzzing.
#pragma once

#include "preproc/mesh/byte_order.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

template <class T>
std::string bytes(T value) {
  std::string text(sizeof(T), '\0');
  store(value, text.data(), std::endian::little);
  return text;
}

// LZF that compresses nothing.
inline std::string lzf_literals(std::string_view data) {
  std::string packed;
  for (; !data.empty(); data.remove_prefix(std::min<std::size_t>(32, data.size()))) {
    const std::string_view piece = data.substr(0, 32);
    packed += static_cast<char>(piece.size() - 1);
    packed += piece;
  }
  return packed;
}

// LAS 1.`minor` in steps of 1e-3 from (100, 0, 0), and two points more: one classed as noise, one withheld.
inline std::string las_file(const std::vector<Vec3>& points, int minor, int format) {
  constexpr std::size_t record_lengths[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  const std::size_t length = record_lengths[format], header = minor >= 4 ? 375 : 227;
  std::string file(header, '\0');
  const auto put = [&](std::size_t at, const std::string& value) { file.replace(at, value.size(), value); };
  put(0, "LASF");
  file[24] = 1;
  file[25] = static_cast<char>(minor);
  put(94, bytes(static_cast<std::uint16_t>(header)));
  put(96, bytes(static_cast<std::uint32_t>(header)));
  file[104] = static_cast<char>(format);
  put(105, bytes(static_cast<std::uint16_t>(length)));
  const std::size_t count = points.size() + 2;
  if (minor >= 4)
    put(247, bytes(static_cast<std::uint64_t>(count)));
  else
    put(107, bytes(static_cast<std::uint32_t>(count)));
  for (std::size_t k = 0; k < 3; ++k) put(131 + 8 * k, bytes(1e-3));
  put(155, bytes(100.0));
  for (std::size_t i = 0; i < count; ++i) {
    std::string record(length, '\0');
    const Vec3 p = i < points.size() ? points[i] : Vec3(5, 5, 5);
    for (std::size_t k = 0; k < 3; ++k) {
      const double offset = k == 0 ? 100 : 0;
      record.replace(4 * k, 4,
                     bytes(static_cast<std::int32_t>(std::lround((p[static_cast<Eigen::Index>(k)] - offset) * 1e3))));
    }
    if (i == points.size()) record[format >= 6 ? 16 : 15] = 7;
    if (i == points.size() + 1) record[15] = static_cast<char>(format >= 6 ? 4 : 0x80);
    file += record;
  }
  return file;
}

}  // namespace scan2fea
