// The nodes of layers behind a surface's vertices, and the elements between them.
#pragma once

#include "preproc/layers/layer_heights.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

// Behind some of a surface's vertices a column of nodes, one for each layer, from the surface inwards. Their numbers
// come after those of the surface's vertices.
struct LayerColumns {
  explicit LayerColumns(std::size_t vertices) : first(vertices, 0), count(vertices, 0) {}

  std::vector<std::uint32_t> first, count;  // per vertex, of `nodes`; none: no column
  std::vector<Vec3> nodes;

  // The k-th behind the vertex; the vertex itself for 0, and where it has no column.
  std::uint32_t node(std::uint32_t vertex, std::uint32_t k) const {
    return k == 0 || count[vertex] == 0 ? vertex : static_cast<std::uint32_t>(count.size()) + first[vertex] + k - 1;
  }
  std::uint32_t last(std::uint32_t vertex) const { return node(vertex, count[vertex]); }
};

struct LayerElements {
  std::vector<Tetrahedron> tetrahedra;
  std::vector<std::uint32_t> of_triangle;  // that each lies behind
};

// Between the columns, layer by layer, wedges of three tetrahedra; of two or one where corners of the triangle have no
// column, so that layers end there. The sides of wedges are parted from the lower of both vertices on the surface's
// side to the higher one, so that neighbours fit. They are positive where the nodes are in the right order.
LayerElements layer_elements(const SurfaceMesh& surface, const LayeredTriangles& layered, const LayerColumns& columns);

}  // namespace scan2fea
