// Edges so short that they are accidents.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

namespace scan2fea {

// Contracts edges shorter than `shortest` (model units), and triangles flatter than it, which a vertex of theirs joins
// to the opposite edge: where shells were united whose corners or faces nearly meet there are many. Vertices move by
// no more than a few times that. Edges whose contraction would change the topology stay. Throws NotMeshable for a
// surface that is no oriented manifold. Linear in rounds, few of them.
SurfaceMesh without_micro_edges(const SurfaceMesh& mesh, double shortest);

}  // namespace scan2fea
