// The faces of tetrahedra, by the elements that have them.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace scan2fea {

struct ElementFaces {
  std::vector<BoundaryFace> boundary;  // of one element; ordered by tetrahedron and face
  // Two elements that cannot both be there: they have their face in common with a third, or all of their corners.
  std::optional<std::array<std::uint32_t, 2>> overlapping = {};
};

// O(n log n).
ElementFaces find_element_faces(const std::vector<Tetrahedron>& tetrahedra);

inline constexpr std::uint32_t no_element = std::numeric_limits<std::uint32_t>::max();

// For each element those across its faces S1 to S4; no_element where there is none, or more than one. O(n log n).
std::vector<std::array<std::uint32_t, 4>> element_neighbours(const std::vector<Tetrahedron>& tetrahedra);

}  // namespace scan2fea
