// Replacing faces between two vertices by an edge: the inverse of edge removal.
#pragma once

#include "preproc/volume/tet_complex.hpp"

namespace scan2fea {

// Takes the face of element t opposite `corner`, and those of its neighbours between the same two apexes that belong
// with it (at most 6), and joins the apexes by an edge through them, if the smallest quality of the cavity rises by the
// factor `gain`. One face is the 2-3 flip. Source: Shewchuk, "Two discrete optimization algorithms for the topological
// improvement of tetrahedral meshes", 2002: the set of faces is the best by a recursion over the tree of faces.
bool remove_faces(TetComplex& complex, std::uint32_t t, std::size_t corner, double gain);

}  // namespace scan2fea
