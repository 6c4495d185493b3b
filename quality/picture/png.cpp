#include "quality/picture/png.hpp"

#include "quality/picture/deflate.hpp"

#include <string_view>
#include <zlib.h>

namespace scan2fea {
namespace {

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
  return bytes;
}

std::string chunk(std::string_view type, std::string_view data) {
  const std::string body = std::string(type) + std::string(data);
  const auto checksum =
      static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
  return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(checksum);
}

}  // namespace

std::string png(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgba) {
  constexpr char bits_per_channel = 8, with_alpha = 6, difference_to_left = 1;
  constexpr std::size_t pixel = 4;
  std::string rows;
  rows.reserve((pixel * width + 1) * height);
  for (std::size_t y = 0; y < height; ++y) {
    rows += difference_to_left;
    const std::span row = rgba.subspan(pixel * width * y, pixel * width);
    for (std::size_t x = 0; x < row.size(); ++x) rows += static_cast<char>(row[x] - (x >= pixel ? row[x - pixel] : 0));
  }
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big_endian(width) + big_endian(height) + bits_per_channel + with_alpha + std::string(3, '\0')) +
         chunk("IDAT", deflated(rows)) + chunk("IEND", {});
}

}  // namespace scan2fea
