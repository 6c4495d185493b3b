#include "quality/curved_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scan2fea {
namespace {

Vec3 at(const SixNodeTriangle& x, const Eigen::Vector2d& place) {
  return point_on(x, {1 - place[0] - place[1], place[0], place[1]});
}

// The curve lies at the sum of 4 a b (m - (p + q) / 2) over the edges, with a and b its coordinates, from the flat
// triangle: at most four ninths of the sum of these bends (in the centre), or the largest of them (on its edge). Cut
// into n along each edge, it bends n^2 times less.
int cuts_for(const SixNodeTriangle& x, double tolerance) {
  double sum = 0, largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double bend = (x[3 + k] - 0.5 * (x[k] + x[(k + 1) % 3])).norm();
    sum += bend;
    largest = std::max(largest, bend);
  }
  const double farthest = std::max(largest, 4.0 / 3 * std::min(largest, sum / 3));
  if (!(farthest > tolerance)) return 1;
  const double cuts = std::ceil(std::sqrt(farthest / tolerance));
  return static_cast<int>(std::clamp(cuts, 1.0, static_cast<double>(most_cuts)));
}

SixNodeTriangle nodes_of(const FlatPieces& pieces, std::uint32_t curved) {
  SixNodeTriangle x;
  for (std::size_t k = 0; k < 6; ++k) x[k] = pieces.nodes[pieces.curved[curved].nodes[k]];
  return x;
}

CurvedTriangle curved_triangle(const TetMesh& mesh, BoundaryFace f) {
  const auto [a, b, c] = boundary_triangle(mesh, f);
  const auto [ab, bc, ca] = boundary_mid_edge_nodes(mesh, f);
  return {{a, b, c, ab, bc, ca}};
}

void add_pieces(FlatPieces& pieces, const CurvedTriangle& triangle, double tolerance) {
  const auto curved = static_cast<std::uint32_t>(pieces.curved.size());
  pieces.curved.push_back(triangle);
  const SixNodeTriangle x = nodes_of(pieces, curved);
  const int n = cuts_for(x, tolerance);
  const auto first = static_cast<std::uint32_t>(pieces.mesh.vertices.size());
  const auto place = [&](int i, int j) -> Eigen::Vector2d { return Eigen::Vector2d(i, j) / n; };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i + j <= n; ++i) pieces.mesh.vertices.push_back(at(x, place(i, j)));
  const auto vertex = [&](int i, int j) {  // rows of n + 1, n, ... vertices
    return first + static_cast<std::uint32_t>(j * (n + 1) - j * (j - 1) / 2 + i);
  };
  const auto add = [&](std::array<std::array<int, 2>, 3> c) {
    pieces.mesh.triangles.push_back({vertex(c[0][0], c[0][1]), vertex(c[1][0], c[1][1]), vertex(c[2][0], c[2][1])});
    pieces.places.push_back({place(c[0][0], c[0][1]), place(c[1][0], c[1][1]), place(c[2][0], c[2][1])});
    pieces.of_piece.push_back(curved);
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i + j < n; ++i) {
      add({{{i, j}, {i + 1, j}, {i, j + 1}}});
      if (i + j + 1 < n) add({{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
    }
}

}  // namespace

Vec3 FlatPieces::on_curve(std::uint32_t piece, double first, double second) const {
  const auto& [a, b, c] = places[piece];
  return at(nodes_of(*this, of_piece[piece]), first * a + second * b + (1 - first - second) * c);
}

std::vector<BoundaryFace> outer_faces_by_element(const TetMesh& mesh) {
  std::vector<BoundaryFace> faces(mesh.boundary.begin(),
                                  mesh.boundary.begin() + static_cast<std::ptrdiff_t>(mesh.outer_faces()));
  std::sort(faces.begin(), faces.end(), [](BoundaryFace a, BoundaryFace b) {
    return a.tetrahedron != b.tetrahedron ? a.tetrahedron < b.tetrahedron : a.face < b.face;
  });
  return faces;
}

SurfaceMesh outer_corner_faces(const TetMesh& mesh) {
  SurfaceMesh surface{.vertices = mesh.nodes, .triangles = {}};
  for (std::size_t f = 0; f < mesh.outer_faces(); ++f)
    surface.triangles.push_back(boundary_triangle(mesh, mesh.boundary[f]));
  return surface;
}

FlatPieces flat_pieces(const TetMesh& mesh, std::span<const BoundaryFace> faces, double tolerance) {
  FlatPieces pieces;
  pieces.nodes = mesh.nodes;
  for (const BoundaryFace f : faces) add_pieces(pieces, curved_triangle(mesh, f), tolerance);
  return pieces;
}

FlatPieces flat_pieces(std::vector<Vec3> nodes, std::span<const CurvedTriangle> triangles, double tolerance) {
  FlatPieces pieces;
  pieces.nodes = std::move(nodes);
  for (const CurvedTriangle& triangle : triangles) add_pieces(pieces, triangle, tolerance);
  return pieces;
}

FlatPieces flat_pieces(const TetMesh& mesh, double tolerance, FacesBetween between) {
  FlatPieces pieces = flat_pieces(mesh, outer_faces_by_element(mesh), tolerance);
  if (between == FacesBetween::left_out) return pieces;
  for (std::size_t i = mesh.outer_faces(); i < mesh.boundary.size(); ++i) {
    const CurvedTriangle face = curved_triangle(mesh, mesh.boundary[i]);
    const auto [a, b, c, ab, bc, ca] = face.nodes;
    add_pieces(pieces, face, tolerance);
    add_pieces(pieces, {{a, c, b, ca, bc, ab}}, tolerance);
  }
  return pieces;
}

}  // namespace scan2fea
