#include "preproc/layers/layer_columns.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace scan2fea {
namespace {

// Behind the triangle, from the k-th nodes to the next ones. Its corners are p < q < r, and `is_turned` tells whether
// that is against its own order.
void add_wedge(const Triangle& corners, bool is_turned, const LayerColumns& columns, std::uint32_t k,
               std::vector<Tetrahedron>& tetrahedra) {
  const auto& [p, q, r] = corners;
  const std::array<std::uint32_t, 3> outer{columns.node(p, k), columns.node(q, k), columns.node(r, k)};
  const std::array<std::uint32_t, 3> inner{columns.node(p, k + 1), columns.node(q, k + 1), columns.node(r, k + 1)};
  // A path from the outer nodes to the inner ones changes one corner after the other, the last one first.
  for (std::size_t changed = 3; changed-- > 0;) {
    if (outer[changed] == inner[changed]) continue;
    Tetrahedron t{};
    std::size_t size = 0;
    for (std::size_t c = 0; c <= changed; ++c) t[size++] = outer[c];
    for (std::size_t c = changed; c < 3; ++c) t[size++] = inner[c];
    // The outer triangle is counter-clockwise seen from outside, and what is added to it lies behind.
    if (is_turned != (changed % 2 == 0)) std::swap(t[0], t[1]);
    tetrahedra.push_back(t);
  }
}

}  // namespace

LayerElements layer_elements(const SurfaceMesh& surface, const LayeredTriangles& layered, const LayerColumns& columns) {
  LayerElements elements;
  for (std::uint32_t f = 0; f < surface.triangles.size(); ++f) {
    if (layered.of_triangle[f] == no_layers) continue;
    Triangle corners = surface.triangles[f];
    bool is_turned = false;
    for (const std::size_t i : {0U, 1U, 0U})
      if (corners[i] > corners[i + 1]) {
        std::swap(corners[i], corners[i + 1]);
        is_turned = !is_turned;
      }
    const auto layers = static_cast<std::uint32_t>(layered.heights[layered.of_triangle[f]].count);
    for (std::uint32_t k = 0; k < layers; ++k) add_wedge(corners, is_turned, columns, k, elements.tetrahedra);
    elements.of_triangle.resize(elements.tetrahedra.size(), f);
  }
  return elements;
}

}  // namespace scan2fea
