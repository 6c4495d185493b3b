// A surface cut open along its feature edges, so that what runs on it sees each smooth side by itself: normals, fields,
// searches and fits then never reach across an edge of the part.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

struct CutSurface {
  SurfaceMesh mesh;  // faces as before; a vertex on a cut is there once for each side that its cuts part
  // Per vertex of `mesh`, the vertex of the surface that it is a copy of. The first copy keeps its vertex's number;
  // further ones follow after all of them.
  std::vector<std::uint32_t> vertex_of_copy;
};

// Corners of faces are one copy where faces hang together around the vertex by edges that are not cut; so a cut that
// ends inside the surface is a slit. Edges that are not in the mesh and boundary edges cut nothing. The components of
// the result (see components.hpp) are called patches. Linear but for a sort of the edges.
CutSurface cut_along(const SurfaceMesh& mesh, std::span<const FeatureEdge> edges);

// Edges of one triangle only, in ascending order. Precondition: oriented, manifold. Linear.
std::vector<FeatureEdge> boundary_edges(const SurfaceMesh& mesh);

}  // namespace scan2fea
