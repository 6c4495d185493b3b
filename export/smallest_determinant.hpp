// Whether CalculiX will find an element too small.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <cstdint>

namespace scan2fea {

// CalculiX stops with "nonpositive jacobian determinant" at elements whose determinant is below this, whatever the
// unit of length: a part with features of some micrometres, written in metres, meets it.
inline constexpr double calculix_smallest_determinant = 1e-20;

// The smallest determinant of the map from the reference tetrahedron, over all elements and the integration points at
// which CalculiX evaluates it (one for C3D4: six times the volume; four for C3D10), in the unit of length cubed.
struct SmallestDeterminant {
  double value = 0;
  std::uint32_t tetrahedron = 0;
};
SmallestDeterminant smallest_determinant(const TetMesh& mesh);

}  // namespace scan2fea
