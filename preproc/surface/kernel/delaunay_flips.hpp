// Restores the Delaunay property of a triangulated surface around a vertex by edge flips.
// Source: Lawson's algorithm with the angle criterion for surfaces: an edge is flipped where the angles opposite to it
// sum to more than 180 degrees.
#pragma once

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <functional>
#include <span>

namespace scan2fea {

struct DelaunayFlipLimits {
  // Edges with a larger angle between their faces' normals are creases and stay; a flip must not make one either.
  // Degrees, 0 to 90. 40 lies between scan noise and the edges of parts.
  double crease_deg = 40;
  // Edges that stay whatever their angle, sorted.
  std::span<const FeatureEdge> kept;
  // Edges for which it is false stay as well.
  std::function<bool(HalfedgeMesh::Index)> may_flip = {};
};

// Starts from the edges opposite to v and goes on where a flip has changed an edge's faces. Returns the number of
// flips. No flip turns a face's normal by more than 90 degrees from its two predecessors' mean. About O(valence of v).
std::size_t restore_delaunay(HalfedgeMesh& mesh, HalfedgeMesh::Index v, const DelaunayFlipLimits& limits = {});

}  // namespace scan2fea
