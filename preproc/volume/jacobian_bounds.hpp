// The Jacobian determinant of a second-order tetrahedron, over the whole element and not at samples.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <array>
#include <cstdint>

namespace scan2fea {

// Coefficients of the determinant of dx/d(reference coordinates), a cubic polynomial, in the Bernstein basis of degree
// 3: the determinant lies between the least and the largest of them everywhere in the element, and their mean is six
// times the element's volume. The first four are its values at the corners. Source: Johnen, Remacle and Geuzaine,
// "Geometrical validity of curvilinear finite elements", 2013. Some 300 ns.
// `corners` and `middles` are the ten nodes, middles in the order of `tetrahedron_edges`.
std::array<double, 20> jacobian_coefficients(const std::array<Vec3, 4>& corners, const std::array<Vec3, 6>& middles);

// Of element t of a second-order mesh.
std::array<double, 20> jacobian_coefficients(const TetMesh& mesh, std::size_t t);

// Volume enclosed by a mesh of either order, curved edges included.
double curved_volume(const TetMesh& mesh);

}  // namespace scan2fea
