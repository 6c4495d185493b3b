// Which triangles of a surface have layers of elements behind them, and how high these are.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace scan2fea {

// Layers from the surface inwards, each `growth` times as high as the one before it.
struct LayerHeights {
  int count = 1;      // at least 1
  double first = 0;   // height of the outermost, model units, above 0
  double growth = 1;  // at least 1

  double total() const { return height_of(count); }
  // Of the k-th node behind one of the surface, in parts of the total: 0 of the surface, 1 of the last one.
  double share(int k) const { return height_of(k) / total(); }

  bool operator==(const LayerHeights&) const = default;

 private:
  double height_of(int layers) const {
    double sum = 0, height = first;
    for (int k = 0; k < layers; ++k, height *= growth) sum += height;
    return sum;
  }
};

inline constexpr std::uint32_t no_layers = std::numeric_limits<std::uint32_t>::max();

struct LayeredTriangles {
  std::vector<LayerHeights> heights;
  std::vector<std::uint32_t> of_triangle;  // an index into `heights`, or no_layers
};

}  // namespace scan2fea
