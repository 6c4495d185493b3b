#include "preproc/bodies/contact_faces.hpp"

#include "preproc/surface/kernel/adjacency.hpp"

#include <cstdint>

namespace scan2fea {
namespace {

// A connected piece of triangles that are all in contact, or all not.
struct Piece {
  std::vector<std::uint32_t> triangles;
  double area = 0;
  double border = 0;  // length
};

Piece flood(const SurfaceMesh& mesh, const std::vector<Triangle>& neighbours, const std::vector<bool>& listed,
            const std::vector<bool>& in_contact, std::uint32_t seed, std::vector<bool>& reached) {
  Piece piece{.triangles = {seed}};
  reached[seed] = true;
  for (std::size_t i = 0; i < piece.triangles.size(); ++i) {
    const std::uint32_t f = piece.triangles[i];
    const Triangle& t = mesh.triangles[f];
    piece.area += area_vector(mesh, t).norm() / 2;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t n = neighbours[f][k];
      if (n == no_face || !listed[n] || in_contact[n] != in_contact[f]) {
        piece.border += (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[(k + 2) % 3]]).norm();
      } else if (!reached[n]) {
        reached[n] = true;
        piece.triangles.push_back(n);
      }
    }
  }
  return piece;
}

// A strip of width w has an area of w / 2 times its border.
void drop_narrow_pieces(const SurfaceMesh& mesh, const std::vector<bool>& listed, double tolerance,
                        std::vector<bool>& in_contact) {
  const MeshAdjacency adjacency(mesh);
  std::vector<bool> reached(mesh.triangles.size(), false);
  for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (reached[seed] || !listed[seed]) continue;
    const Piece piece = flood(mesh, adjacency.neighbours, listed, in_contact, seed, reached);
    if (piece.area < tolerance / 2 * piece.border)
      for (const std::uint32_t f : piece.triangles) in_contact[f] = !in_contact[f];
  }
}

}  // namespace

std::vector<bool> contact_faces(const SplitSurface& surface, const std::vector<bool>& listed, const FacingSurface& own,
                                const FacingSurface& other, double tolerance) {
  const SurfaceMesh& mesh = surface.mesh();
  std::vector<bool> in_contact(mesh.triangles.size(), false);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    if (listed[f])
      in_contact[f] =
          other.under(centroid(mesh, mesh.triangles[f]), own.normal(surface.origin(f)), tolerance).has_value();
  drop_narrow_pieces(mesh, listed, tolerance, in_contact);
  return in_contact;
}

}  // namespace scan2fea
