#pragma once

#include "preproc/mesh/require_memory.hpp"

#include <string>

namespace scan2fea {

// Throws NotMeshable where the machine cannot hold so many triangles of a surface, with the scan refined for them and
// all that is made of it: 200 bytes each, measured on scans of millions. `advice`: what to try.
inline void require_memory_of_triangles(double count, const std::string& advice) {
  constexpr double bytes_each = 200;
  require_memory(count, bytes_each, "triangles", advice);
}

}  // namespace scan2fea
