// A PNG file, written by zlib.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace scan2fea {

// `rgba`: four bytes a pixel, rows from the top, not premultiplied. Precondition: width and height are above 0, and
// rgba.size() == 4 * width * height.
std::string png(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgba);

}  // namespace scan2fea
