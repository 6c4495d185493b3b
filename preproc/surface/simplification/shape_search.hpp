// Smaller triangles where they cannot be well shaped otherwise.
#pragma once

#include "preproc/surface/simplification/surface_candidate.hpp"

namespace scan2fea {

// Where edges and sides of a body are nearer to one another than the triangles are wide, no triangles of the wanted
// size have a good shape, and their bad angles pass on to tetrahedra. So: make a surface as `make_surface` does; where
// its triangles have angles below 30 degrees, or elements across a wall would have less than 25, or the lattice gave
// way, shorten the wanted edges around them by a quarter to a half and make it again, until none is left, nothing more
// is gained, or it would have three times the triangles that were wanted (8,000, but at most forty times, for small
// parts). Where two creases meet at less than 19 degrees, the smoother is given up near by. Of the surfaces made the
// one whose smallest angle is largest is given; small parts (wanted with less than 1,000 triangles) keep edges first. A
// well shaped first surface costs one pass over its triangles, with three searches each; large ones are renewed only
// below 17 degrees, as long as each renewal gains. Throws what make_surface throws where not even the first surface can
// be made.
Candidate make_shaped_surface(PreparedScanPointer scan, const SizingOptions& sizing, const SimplifyOptions& options,
                              const Progress& progress);

}  // namespace scan2fea
