// How many tetrahedra will come out, told before the mesher runs.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <optional>

namespace scan2fea {

// From the number of lattice points: each carries 5.9 tetrahedra, each surface vertex 3 (a body-centred lattice has 6
// a point; the rest is measured). Within 10 % on bodies at least a few edges thick, within 30 % on thinner ones.
std::size_t estimate_with_lattice(const SurfaceMesh& surface, std::size_t lattice_points);

// For TetGen's own points: with r the volume over area times mean edge length (half a plate's thickness in edges),
// 2.25 + 0.65 log2(r) tetrahedra a triangle, 1.4 at least, or what the largest volume asks for. Measured on spheres,
// plates, boxes and scans; within 20 % where the triangles are near equilateral, more come of needles.
std::size_t estimate_with_tetgen(const SurfaceMesh& surface, const std::optional<double>& max_volume);

}  // namespace scan2fea
