// Smaller triangles where they cannot be well shaped otherwise.
#pragma once

#include "preproc/surface/surface_candidate.hpp"

namespace scan2fea {

// Where edges and thin parts of a body are nearer to one another than the triangles are wide, no triangles of the
// wanted size have a good shape, and their bad angles pass on to tetrahedra. So: make a surface as `make_surface` does;
// where its triangles have angles below 25 degrees, or the lattice gave way, shorten the wanted edges around them by a
// quarter and make it again, until none is left or it would have six times the triangles that were wanted. Short
// creases that meet others at less than 25 degrees are folds of a scan, and are given up where they do. Of the surfaces
// made the one whose smallest angle is largest is given; the result's remark says what it took. Corners between long
// creases stay as sharp as the part has them. A well shaped first surface costs one pass over its triangles. Throws
// what make_surface throws where not even the first surface can be made.
Candidate make_shaped_surface(PreparedScan& scan, const SizingOptions& sizing, const SimplifyOptions& options,
                              SimplifyResult& result, const Progress& progress);

}  // namespace scan2fea
