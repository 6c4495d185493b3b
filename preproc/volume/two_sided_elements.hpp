// Elements with two sides on a smooth boundary, which cannot be curved.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace scan2fea {

// Where an element's two boundary faces meet at an edge of a smooth surface, their curved forms share a tangent plane
// there, and the element's Jacobian is zero along the edge: however good it is with straight edges, it must stay
// straight. A vertex inside parts it, so that each of its halves has one side. `creases`: edges of the boundary at
// which the surface turns, the smaller node first, sorted. The boundary stays. The mesh is of first order; nodes from
// `kept` on may be renumbered. An element stays where that costs more than half of the least quality around it, or
// leaves what could not be curved. Returns the number that was parted. O(n), and some 100 us each.
std::size_t part_two_sided_elements(TetMesh& mesh, std::size_t kept,
                                    std::span<const std::array<std::uint32_t, 2>> creases);

}  // namespace scan2fea
