// Which tetrahedra share which faces, and which of these faces are surface triangles.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace scan2fea {

inline constexpr std::uint32_t no_link = std::numeric_limits<std::uint32_t>::max();

// Corner k of a tetrahedron faces the triangle of its other three corners; counter-clockwise seen from outside a
// positive tetrahedron.
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> opposite_face{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

// The same face as an index into `tetrahedron_faces` (Abaqus's S1 to S4, less one).
inline constexpr std::array<std::uint8_t, 4> face_of_opposite_corner{2, 3, 1, 0};

inline Triangle face_opposite(const Tetrahedron& t, std::size_t corner) {
  const auto& local = opposite_face[corner];
  return {t[local[0]], t[local[1]], t[local[2]]};
}

struct FaceLinks {
  // Per tetrahedron and corner: what lies on the opposite face, `no_link` for nothing.
  std::vector<std::array<std::uint32_t, 4>> neighbour;  // a tetrahedron
  std::vector<std::array<std::uint32_t, 4>> triangle;   // an index into the triangles given
};

// Faces are the same when they have the same corners, in whatever order. Where more than two tetrahedra share a face
// (not a valid mesh) the first two are linked. O(n): faces are sorted by their least corner first.
FaceLinks link_faces(const std::vector<Tetrahedron>& tetrahedra, const std::vector<Triangle>& triangles,
                     std::size_t node_count);

}  // namespace scan2fea
