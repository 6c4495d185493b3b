// Numbers in the bytes of binary files.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace scan2fea {

// The number of type T stored at `at`, which need not be aligned.
template <class T>
T load(const char* at, std::endian order) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

template <class T>
void store(T value, char* at, std::endian order) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  std::memcpy(at, bytes.data(), sizeof(T));
}

}  // namespace scan2fea
