#include "preproc/surface/kernel/adjacency.hpp"

namespace scan2fea {

Vec3 middle_of_neighbours(const SurfaceMesh& mesh, const VertexStars& stars, std::uint32_t vertex) {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (const std::uint32_t corner : stars.corners(vertex))
    for (const std::uint32_t v : mesh.triangles[corner / 3])
      if (v != vertex) {
        sum += mesh.vertices[v];
        ++count;
      }
  return sum / count;
}

std::vector<Vec3> face_normals(const SurfaceMesh& mesh) {
  std::vector<Vec3> normals(mesh.triangles.size());
  for (std::size_t f = 0; f < normals.size(); ++f) {
    const Vec3 n = area_vector(mesh, mesh.triangles[f]);
    const double length = n.norm();
    normals[f] = length > 0 ? Vec3(n / length) : Vec3::Zero();
  }
  return normals;
}

std::vector<Vec3> vertex_normals(const SurfaceMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n = area_vector(mesh, t);
    for (const std::uint32_t v : t) normals[v] += n;
  }
  for (Vec3& n : normals) {
    const double length = n.norm();
    if (length > 0) n /= length;
  }
  return normals;
}

std::vector<std::vector<std::uint32_t>> colour_vertices(const SurfaceMesh& mesh, const VertexStars& stars) {
  constexpr std::uint32_t uncoloured = no_face;
  std::vector<std::uint32_t> colour(mesh.vertices.size(), uncoloured);
  std::vector<std::vector<std::uint32_t>> sets;
  std::vector<std::uint32_t> taken_by;  // per colour, the last vertex that found it in its neighbourhood
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (stars.corners(v).empty()) continue;
    for (const std::uint32_t corner : stars.corners(v)) {
      for (const std::uint32_t w : mesh.triangles[corner / 3]) {
        if (colour[w] != uncoloured) taken_by[colour[w]] = v;
      }
    }
    std::uint32_t c = 0;
    while (c < sets.size() && taken_by[c] == v) ++c;
    if (c == sets.size()) {
      sets.emplace_back();
      taken_by.push_back(uncoloured);
    }
    colour[v] = c;
    sets[c].push_back(v);
  }
  return sets;
}

}  // namespace scan2fea
