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

// Each edge is looked at from its vertex of the smaller index, so that each star is read once.
std::vector<Triangle> face_neighbours(const SurfaceMesh& mesh, const VertexStars& stars) {
  struct Spoke {           // an edge of a triangle at the vertex
    std::uint32_t vertex;  // at its other end
    std::uint32_t face, opposite;
    bool leaves;  // the vertex, in the triangle's direction
  };
  std::vector<Triangle> neighbours(mesh.triangles.size(), Triangle{no_face, no_face, no_face});
  std::vector<Spoke> spokes;
  for (std::uint32_t v = 0; v < stars.vertex_count(); ++v) {
    spokes.clear();
    for (const std::uint32_t corner : stars.corners(v)) {
      const std::uint32_t f = corner / 3, k = corner % 3;
      const std::uint32_t to = mesh.triangles[f][(k + 1) % 3], from = mesh.triangles[f][(k + 2) % 3];
      if (to >= v) spokes.push_back({to, f, (k + 2) % 3, true});
      if (from >= v) spokes.push_back({from, f, (k + 1) % 3, false});
    }
    for (const Spoke& out : spokes) {
      if (!out.leaves) continue;
      const Spoke* in = nullptr;
      int leaving = 0, arriving = 0;
      for (const Spoke& other : spokes) {
        if (other.vertex != out.vertex) continue;
        ++(other.leaves ? leaving : arriving);
        if (!other.leaves) in = &other;
      }
      if (leaving != 1 || arriving != 1) continue;
      neighbours[out.face][out.opposite] = in->face;
      neighbours[in->face][in->opposite] = out.face;
    }
  }
  return neighbours;
}

}  // namespace scan2fea
