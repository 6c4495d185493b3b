// Bytes as a page carries them.
#pragma once

#include <string>
#include <string_view>

namespace scan2fea {

// With zlib's head and checksum, as DecompressionStream("deflate") expands them.
std::string deflated(std::string_view bytes);

std::string base64(std::string_view bytes);

}  // namespace scan2fea
