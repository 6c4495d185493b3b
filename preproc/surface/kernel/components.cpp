#include "preproc/surface/kernel/components.hpp"

#include "preproc/mesh/union_find.hpp"

#include <algorithm>
#include <limits>

namespace scan2fea {

Components find_components(const SurfaceMesh& mesh) {
  UnionFind sets(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
  }
  Components components;
  components.of_vertex.resize(mesh.vertices.size());
  // A set's root is its smallest member, so it comes first.
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const std::uint32_t root = sets.find(v);
    components.of_vertex[v] = root == v ? components.count++ : components.of_vertex[root];
  }
  return components;
}

std::vector<double> diagonals(const SurfaceMesh& mesh, const Components& components) {
  std::vector<Vec3> low(components.count, Vec3::Constant(std::numeric_limits<double>::infinity())),
      high(components.count);
  for (Vec3& h : high) h = -low.front();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const std::uint32_t c = components.of_vertex[v];
    low[c] = low[c].cwiseMin(mesh.vertices[v]);
    high[c] = high[c].cwiseMax(mesh.vertices[v]);
  }
  std::vector<double> diagonal;
  for (std::size_t c = 0; c < components.count; ++c) diagonal.push_back((high[c] - low[c]).norm());
  return diagonal;
}

BodySizes body_sizes(const SurfaceMesh& mesh) {
  if (mesh.triangles.empty()) return {};
  // A vertex without a triangle is no body.
  const Components components = find_components(mesh);
  const std::vector<double> diagonal = diagonals(mesh, components);
  BodySizes sizes{.smallest = std::numeric_limits<double>::infinity()};
  for (const Triangle& t : mesh.triangles) {
    const double d = diagonal[components.of_vertex[t[0]]];
    sizes.smallest = std::min(sizes.smallest, d);
    sizes.largest = std::max(sizes.largest, d);
  }
  return sizes;
}

std::vector<long> euler_characteristics(const SurfaceMesh& mesh, const Components& components,
                                        std::span<const FeatureEdge> border) {
  // E = (3 F + border) / 2.
  std::vector<long> vertices(components.count, 0), twice_edges_less_faces(components.count, 0);
  for (const std::uint32_t c : components.of_vertex) ++vertices[c];
  for (const Triangle& t : mesh.triangles) ++twice_edges_less_faces[components.of_vertex[t[0]]];
  for (const FeatureEdge& e : border) ++twice_edges_less_faces[components.of_vertex[e[0]]];
  for (std::size_t c = 0; c < vertices.size(); ++c) vertices[c] -= twice_edges_less_faces[c] / 2;
  return vertices;
}

}  // namespace scan2fea
