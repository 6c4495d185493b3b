#include "preproc/surface/kernel/rings.hpp"

#include <algorithm>
#include <utility>

namespace scan2fea {

void grow(const SurfaceMesh& mesh, FaceMarks& marks, int rings) {
  std::vector<char> at_vertex(mesh.vertices.size());
  for (int ring = 0; ring < rings; ++ring) {
    std::fill(at_vertex.begin(), at_vertex.end(), 0);
    for (std::size_t f = 0; f < marks.size(); ++f)
      if (marks[f])
        for (const std::uint32_t v : mesh.triangles[f]) at_vertex[v] = 1;
    for (std::size_t f = 0; f < marks.size(); ++f)
      for (const std::uint32_t v : mesh.triangles[f]) marks[f] |= at_vertex[v];
  }
}

void grow_vertices(const SurfaceMesh& mesh, std::vector<bool>& vertices, int rings) {
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<bool> grown = vertices;
    for (const Triangle& t : mesh.triangles) {
      if (vertices[t[0]] || vertices[t[1]] || vertices[t[2]]) grown[t[0]] = grown[t[1]] = grown[t[2]] = true;
    }
    vertices = std::move(grown);
  }
}

std::vector<bool> vertices_around(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces, int rings) {
  std::vector<bool> inside(mesh.vertices.size(), false);
  for (const std::uint32_t f : faces) {
    for (const std::uint32_t v : mesh.triangles[f]) inside[v] = true;
  }
  grow_vertices(mesh, inside, rings);
  return inside;
}

}  // namespace scan2fea
