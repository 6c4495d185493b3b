// One mesh of layers and of what lies behind them.
#pragma once

#include "preproc/layers/layer_columns.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <cstddef>
#include <vector>

namespace scan2fea {

// An edge of the mesh that runs along an edge of the surface, behind it or where it made room.
struct ParallelEdge {
  FeatureEdge edge;        // of the mesh's nodes
  FeatureEdge of_surface;  // of the surface's vertices

  auto operator<=>(const ParallelEdge&) const = default;
};

struct LayeredMesh {
  TetMesh mesh;         // first the elements of the layers
  SurfaceMesh surface;  // its boundary: first the triangles given, in their order, then those beside layers
  // Edges that stand for lines of the scan: those given, which run on along columns where these are on lines.
  std::vector<FeatureEdge> lines;
  // All of the surface's edges, and those between columns: across layers, and over one of them. Sorted.
  std::vector<ParallelEdge> parallel;
  std::size_t layer_tetrahedra = 0;
};

// `core` fills `surface` with each vertex that has a column at the column's end. The vertices stay the first of the
// result's, in their order, and of the columns' nodes those on the boundary come next. Throws MeshingFailed where the
// layers and the core do not fit. O(n log n).
LayeredMesh join_layers(const SurfaceMesh& surface, const LayeredTriangles& layered, const LayerColumns& columns,
                        const TetMesh& core, const std::vector<FeatureEdge>& lines);

}  // namespace scan2fea
