#include "export/compressed_blocks.hpp"

#include <limits>
#include <lz4.h>
#include <stdexcept>
#include <zlib.h>

namespace scan2fea {
namespace {

// `expand` fills a block from its compressed bytes and says whether it succeeded. No compressor shrinks by more than
// `largest_ratio`.
template <class Expand>
std::string expand_blocks(std::string_view bytes, const BlockSizes& sizes, std::uint64_t largest_ratio,
                          const Expand& expand) {
  std::string all;
  for (std::size_t b = 0; b < sizes.compressed.size(); ++b) {
    const bool is_last = b + 1 == sizes.compressed.size();
    const std::uint64_t size = is_last && sizes.last != 0 ? sizes.last : sizes.block;
    const std::uint64_t compressed = sizes.compressed[b];
    if (size / largest_ratio > compressed || size > std::numeric_limits<int>::max() ||
        compressed > std::numeric_limits<int>::max())
      throw std::runtime_error("promises more than its compressed bytes can hold");
    const std::size_t before = all.size();
    all.resize(before + size);
    if (!expand(bytes.substr(0, compressed), all.data() + before, size))
      throw std::runtime_error("has a broken compressed block");
    bytes.remove_prefix(compressed);
  }
  return all;
}

}  // namespace

std::string inflate_blocks(std::string_view bytes, const BlockSizes& sizes) {
  return expand_blocks(bytes, sizes, 1032, [](std::string_view from, char* to, std::uint64_t size) {
    uLongf written = size;
    return uncompress(reinterpret_cast<Bytef*>(to), &written, reinterpret_cast<const Bytef*>(from.data()),
                      from.size()) == Z_OK &&
           written == size;
  });
}

std::string expand_lz4_blocks(std::string_view bytes, const BlockSizes& sizes) {
  return expand_blocks(bytes, sizes, 255, [](std::string_view from, char* to, std::uint64_t size) {
    return LZ4_decompress_safe(from.data(), to, static_cast<int>(from.size()), static_cast<int>(size)) ==
           static_cast<int>(size);
  });
}

}  // namespace scan2fea
