// Which shape each triangle lies on, from what its vertices lie on.
#pragma once

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/primitives/find_primitives.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

class TriangleLabels {
 public:
  // `mesh` is cut along its creases, and `found` are the primitives of its vertices. Keeps references.
  TriangleLabels(const SurfaceMesh& mesh, const Primitives& found);

  // Per triangle a primitive or no_primitive: of those that vertices within two rings have, the one that is nearest to
  // the triangle's corners and the vertices around them, by distance and normal. One vertex tells little of which of
  // two tangent shapes it is on where there is noise; several do. Linear.
  std::vector<std::uint32_t> label();

  // Of a triangle's corners alone, in squared sigmas each (see shape_rating.hpp).
  double cost(std::uint32_t triangle, std::uint32_t label) const;

  const Primitives& primitives() const { return found_; }

 private:
  double vertex_cost(std::uint32_t vertex, std::uint32_t label) const;
  double cost_around(std::uint32_t triangle, std::uint32_t label) const;

  const SurfaceMesh& mesh_;
  const Primitives& found_;
  VertexStars stars_;
};

}  // namespace scan2fea
