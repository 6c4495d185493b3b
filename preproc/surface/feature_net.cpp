#include "preproc/surface/feature_net.hpp"

#include <algorithm>

namespace scan2fea {

std::vector<FeatureEdge> edges_of(const FeatureNet& net) {
  std::vector<FeatureEdge> edges;
  for (const FeatureLine& line : net.lines) {
    const std::size_t count = line.vertices.size();
    for (std::size_t i = 0; i + (line.closed ? 0 : 1) < count; ++i)
      edges.push_back(feature_edge(line.vertices[i].vertex, line.vertices[(i + 1) % count].vertex));
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

std::vector<bool> vertices_on_lines(const FeatureNet& net, std::size_t vertices) {
  std::vector<bool> on_line(vertices, false);
  for (const FeatureLine& line : net.lines)
    for (const VertexOnLine& at : line.vertices) on_line[at.vertex] = true;
  return on_line;
}

VertexConstraints held_lines(const FeatureNet& net, std::size_t vertices) {
  if (net.empty()) return {};
  VertexConstraints constraints(vertices, VertexConstraint::free);
  for (const FeatureLine& line : net.lines)
    for (const VertexOnLine& at : line.vertices) constraints[at.vertex] = VertexConstraint::fixed;
  return constraints;
}

}  // namespace scan2fea
