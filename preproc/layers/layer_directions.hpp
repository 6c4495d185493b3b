// In which direction layers grow from each vertex of a surface.
#pragma once

#include "preproc/mesh/face_neighbours.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <vector>

namespace scan2fea {

struct LayerDirections {
  // Per vertex, the way into the body that is one away from the planes of the layered triangles around it. Zero at
  // vertices that have no such triangle, and where the layers taper off since they have no way.
  std::vector<Vec3> inwards;
  // Per vertex, whether that way runs along triangles without layers: those beside the layered ones.
  std::vector<bool> is_beside;
};

// Triangles around a vertex count as one face where they turn by less than 30 degrees; its normal is their mean by
// their angles there. The way is one away from each layered face, at an edge or a corner between several of them too,
// and lies in the faces beside. There is none where a face beside goes on from the layered ones at less than 30
// degrees, rises above them, or comes back under them at less than 30 degrees, or where three faces lie beside. Within
// a face ways lean as those from its edges do, the less the farther they are from there. Linear.
LayerDirections layer_directions(const SurfaceMesh& surface, const VertexStars& stars,
                                 const std::vector<Triangle>& neighbours, const std::vector<bool>& layered);

}  // namespace scan2fea
