#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <algorithm>

namespace scan2fea {

// A triangle's corners, however it is turned: a key.
inline Triangle sorted(Triangle corners) {
  std::ranges::sort(corners);
  return corners;
}

}  // namespace scan2fea
