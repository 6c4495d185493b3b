// An edge of a surface that is to be kept: a crease, or a piece of a border.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace scan2fea {

// Its vertices, the smaller one first.
using FeatureEdge = std::array<std::uint32_t, 2>;

inline FeatureEdge feature_edge(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace scan2fea
