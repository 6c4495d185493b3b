// Fewer vertices for a scan that has far more than the fields of a lattice need.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

// Contracts short edges to their middles, pass by pass, each vertex at most once a pass, so that what is left stays as
// even as the scan is, until `vertices` are left or topology allows no more. Per vertex of the scan, the one that it
// became. A scan without more vertices stays as it is. Precondition: manifold; topology stays. Vertices and faces keep
// their order. Linear.
std::vector<std::uint32_t> thin_scan(SurfaceMesh& scan, std::size_t vertices);

}  // namespace scan2fea
