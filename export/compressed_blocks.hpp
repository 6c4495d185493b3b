// Blocks of bytes compressed by zlib or LZ4, as VTK's XML files hold them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

struct BlockSizes {
  std::uint64_t block = 0;                // of all but the last one, uncompressed
  std::uint64_t last = 0;                 // of the last one; 0: as the others
  std::vector<std::uint64_t> compressed;  // of each block
};

// The blocks, which follow one another in `bytes`, uncompressed. Both throw std::runtime_error where a block is broken
// or promises more than its bytes can hold. Precondition: the compressed sizes sum to at most bytes.size().
std::string inflate_blocks(std::string_view bytes, const BlockSizes& sizes);
std::string expand_lz4_blocks(std::string_view bytes, const BlockSizes& sizes);

}  // namespace scan2fea
