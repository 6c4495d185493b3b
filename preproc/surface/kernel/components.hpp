// Which parts of a surface hang together, and the topology of each.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

struct Components {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> of_vertex;  // numbered in the order of their first vertices
};

// Connected by sharing vertices; a vertex without a triangle is a component of its own. Nearly linear.
Components find_components(const SurfaceMesh& mesh);

// Per component the diagonal of its bounding box: sizes that go with a body's are of its own, since several in one file
// may lie far apart. Linear.
std::vector<double> diagonals(const SurfaceMesh& mesh, const Components& components);

// Of the smallest and the largest of them; 0 where there is none.
struct BodySizes {
  double smallest = 0, largest = 0;
};
BodySizes body_sizes(const SurfaceMesh& mesh);

// V - E + F per component, where every edge has two triangles but those of `border`, which have one: 2 - 2 genus -
// borders of a manifold one. Linear.
std::vector<long> euler_characteristics(const SurfaceMesh& mesh, const Components& components,
                                        std::span<const FeatureEdge> border = {});

}  // namespace scan2fea
