// Pixels of a picture.
#pragma once

#include <cstdint>
#include <vector>

namespace scan2fea {

// Rows from the top, four bytes a pixel: red, green, blue, not premultiplied, and how much of it is covered.
struct Raster {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;

  std::uint8_t* pixel(std::uint32_t x, std::uint32_t y) { return rgba.data() + 4 * (std::size_t{y} * width + x); }
};

}  // namespace scan2fea
