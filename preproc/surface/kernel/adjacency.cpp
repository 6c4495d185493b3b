#include "preproc/surface/kernel/adjacency.hpp"

#include <numeric>

namespace scan2fea {

VertexStars::VertexStars(const SurfaceMesh& mesh) : first_(mesh.vertices.size() + 1, 0) {
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) ++first_[v + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  corners_.resize(3 * mesh.triangles.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  std::uint32_t corner = 0;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) corners_[next[v]++] = corner++;
  }
}

std::vector<Triangle> face_neighbours(const SurfaceMesh& mesh, const VertexStars& stars) {
  std::vector<Triangle> neighbours(mesh.triangles.size(), Triangle{no_face, no_face, no_face});
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[(k + 1) % 3];
      const std::uint32_t to = t[(k + 2) % 3];
      // The neighbour runs along the edge from `to` to `from`; one more triangle on the edge makes it non-manifold.
      std::uint32_t found = no_face;
      bool manifold = true;
      for (const std::uint32_t corner : stars.corners(to)) {
        const std::uint32_t g = corner / 3;
        const Triangle& u = mesh.triangles[g];
        const std::uint32_t at = corner % 3;
        if (u[(at + 1) % 3] == from) {
          manifold = manifold && found == no_face;
          found = g;
        } else if (u[(at + 2) % 3] == from && g != f) {
          manifold = false;
        }
      }
      if (manifold) neighbours[f][k] = found;
    }
  }
  return neighbours;
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
