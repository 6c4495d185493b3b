// The primitives of a surface with many vertices, found on some of them.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/primitives/find_primitives.hpp"

namespace scan2fea {

// As find_primitives of `mesh`, whose time grows faster than the vertices; of more than 120,000 only evenly spread ones
// are asked, one in each patch of some rings, with the patches beside them as neighbours. The other vertices have the
// label of theirs, and normals of their own, averaged with those around. Throws Cancelled.
Primitives find_thinned_primitives(const SurfaceMesh& mesh, const Progress& progress = {});

}  // namespace scan2fea
