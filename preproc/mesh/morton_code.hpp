// Places on a grid, numbered along a Morton curve: what is near on the curve is near in space.
#pragma once

#include <cstdint>

namespace scan2fea {

// So many bits of each coordinate fit in a code.
inline constexpr int morton_bits = 21;

// Bit i of x, y and z becomes bit 3 i, 3 i + 1 and 3 i + 2. Higher bits than the code has room for are left out.
constexpr std::uint64_t morton_code(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  const auto spread = [](std::uint64_t bits) {  // two zeros after each bit
    bits &= 0x1fffff;
    bits = (bits | bits << 32) & 0x1f00000000ffff;
    bits = (bits | bits << 16) & 0x1f0000ff0000ff;
    bits = (bits | bits << 8) & 0x100f00f00f00f00f;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
    return (bits | bits << 2) & 0x1249249249249249;
  };
  return spread(x) | spread(y) << 1 | spread(z) << 2;
}

}  // namespace scan2fea
