// What an optimisation may do to a vertex.
#pragma once

#include <cstdint>
#include <vector>

namespace scan2fea {

// Vertices on the lines of a FeatureNet that are free slide along them.
enum class VertexConstraint : std::uint8_t { free, fixed };

// One a vertex, or empty where all are free.
using VertexConstraints = std::vector<VertexConstraint>;

}  // namespace scan2fea
