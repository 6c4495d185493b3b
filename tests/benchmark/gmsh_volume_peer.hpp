// Gmsh's HXT mesher for the same task, for comparison only.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

namespace scan2fea::benchmark {

// Fills the surface on one thread, its triangles kept, then optimises `rounds` times. `boundary` is left empty.
TetMesh gmsh_hxt(const SurfaceMesh& surface, int rounds);

}  // namespace scan2fea::benchmark
