#include "preproc/mesh/face_neighbours.hpp"

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

}  // namespace scan2fea
