// Marc Lehmann's LZF, by which PCD files are compressed.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace scan2fea {

// `size` bytes, or nothing where `compressed` does not give exactly those. Memory and time of the smaller of `size` and
// what so many bytes can stand for (132 times as many). Linear.
std::optional<std::string> lzf_decompressed(std::string_view compressed, std::size_t size);

}  // namespace scan2fea
