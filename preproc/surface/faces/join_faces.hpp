// Pieces that noise parted though one shape describes them.
#pragma once

#include "preproc/surface/faces/find_faces.hpp"

#include <vector>

namespace scan2fea {

// `faces`: their triangles and shapes; `smooth`: per triangle its neighbours, no_face across creases; `sigma`: of
// distances, model units, > 0. Where a shape of the larger piece's kind, fitted to both, leaves no more than noise on
// each of them, they become one, the smallest piece first. Numbers in `of_triangle` follow. Costs a fit for each pair
// that is nearly one.
void join_faces(const SurfaceMesh& mesh, const std::vector<Triangle>& smooth, double sigma, SurfaceFaces& faces);

}  // namespace scan2fea
