// Replacing the elements around an edge by better ones without it.
#pragma once

#include "preproc/volume/tet_complex.hpp"

namespace scan2fea {

// Removes the interior edge from corner i to corner j of element t if the ring's smallest quality rises by the factor
// `gain`. The ring's triangulation is the best of all, by dynamic programming over its polygons (Klincsek, "Minimal
// triangulations of polygonal domains", 1980; Shewchuk, "Two discrete optimization algorithms for the topological
// improvement of tetrahedral meshes", 2002). At most 7 elements around the edge, 70 qualities.
// Gives up at once where another element of the ring carries a bit of `tried`: the edge was tried from there.
bool remove_edge(TetComplex& complex, std::uint32_t t, std::size_t i, std::size_t j, double gain,
                 std::uint32_t tried = 0);

}  // namespace scan2fea
