#include "preproc/mesh/lzf.hpp"

namespace scan2fea {

// A byte below 32 announces that many literals and one; any other begins with three bits of a length, of which 7 means
// that a byte follows, and ends with the upper five of a distance.
std::optional<std::string> lzf_decompressed(std::string_view compressed, std::size_t size) {
  constexpr std::size_t largest_ratio = 132;  // 264 bytes of a copy in two
  std::string out;
  if (size / largest_ratio > compressed.size()) return std::nullopt;
  out.reserve(size);
  std::size_t at = 0;
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(compressed[i])); };
  while (at < compressed.size()) {
    const std::size_t control = byte(at++);
    if (control < 32) {
      const std::size_t count = control + 1;
      if (count > compressed.size() - at || count > size - out.size()) return std::nullopt;
      out.append(compressed.substr(at, count));
      at += count;
      continue;
    }
    std::size_t count = control >> 5;
    if (count == 7) {
      if (at == compressed.size()) return std::nullopt;
      count += byte(at++);
    }
    count += 2;
    if (at == compressed.size()) return std::nullopt;
    const std::size_t distance = ((control & 31) << 8) + byte(at++) + 1;
    if (distance > out.size() || count > size - out.size()) return std::nullopt;
    for (std::size_t from = out.size() - distance; count > 0; --count) out.push_back(out[from++]);  // may overlap
  }
  if (out.size() != size) return std::nullopt;
  return out;
}

}  // namespace scan2fea
