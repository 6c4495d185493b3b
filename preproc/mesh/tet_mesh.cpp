#include "preproc/mesh/tet_mesh.hpp"

#include "preproc/mesh/element_faces.hpp"
#include "preproc/mesh/own_vertices.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

// The triangles, each from its first node on, and the nodes that they use.
SurfaceMesh numbered_in_order(const TetMesh& mesh, std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return own_vertices(mesh.nodes, std::move(triangles)).mesh;
}

}  // namespace

Triangle boundary_mid_edge_nodes(const TetMesh& mesh, BoundaryFace f) {
  const auto& [a, b, c] = tetrahedron_faces[f.face];
  const std::array<std::array<int, 2>, 3> sides{{{a, c}, {c, b}, {b, a}}};  // boundary_triangle is a, c, b
  Triangle nodes{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t e = 0; e < tetrahedron_edges.size(); ++e) {
      const auto& [p, q] = tetrahedron_edges[e];
      if ((p == sides[k][0] && q == sides[k][1]) || (q == sides[k][0] && p == sides[k][1]))
        nodes[k] = mesh.mid_edge_nodes[f.tetrahedron][e];
    }
  return nodes;
}

SixNodeTriangle boundary_face_nodes(const TetMesh& mesh, BoundaryFace f) {
  const Triangle corners = boundary_triangle(mesh, f);
  SixNodeTriangle x;
  for (std::size_t k = 0; k < 3; ++k) x[k] = mesh.nodes[corners[k]];
  if (mesh.order() == 1) {
    for (std::size_t k = 0; k < 3; ++k) x[3 + k] = 0.5 * (x[k] + x[(k + 1) % 3]);
    return x;
  }
  const Triangle middles = boundary_mid_edge_nodes(mesh, f);
  for (std::size_t k = 0; k < 3; ++k) x[3 + k] = mesh.nodes[middles[k]];
  return x;
}

double face_area(const TetMesh& mesh, BoundaryFace f) {
  const SixNodeTriangle x = boundary_face_nodes(mesh, f);
  return mesh.order() == 1 ? (x[1] - x[0]).cross(x[2] - x[0]).norm() / 2 : curved_area(x);
}

Vec3 face_vector_area(const TetMesh& mesh, BoundaryFace f) {
  // The normal is of second degree, for which the rule of the edges' middles is exact.
  const SixNodeTriangle x = boundary_face_nodes(mesh, f);
  Vec3 sum = Vec3::Zero();
  for (const std::array<double, 3>& middle : {std::array{0.5, 0.5, 0.0}, {0.0, 0.5, 0.5}, {0.5, 0.0, 0.5}}) {
    const auto [by_second, by_third] = tangents(x, middle);
    sum += by_second.cross(by_third);
  }
  return sum / 6;
}

std::vector<std::uint32_t> nodes_of_faces(const TetMesh& mesh, std::span<const std::uint32_t> faces) {
  std::vector<bool> used(mesh.nodes.size(), false);
  for (const std::uint32_t i : faces) {
    const BoundaryFace f = mesh.boundary[i];
    const auto& corners = tetrahedron_faces[f.face];
    const auto is_corner = [&](int c) { return std::find(corners.begin(), corners.end(), c) != corners.end(); };
    for (const int c : corners) used[mesh.tetrahedra[f.tetrahedron][static_cast<std::size_t>(c)]] = true;
    if (mesh.order() == 1) continue;
    for (std::size_t e = 0; e < tetrahedron_edges.size(); ++e)
      if (is_corner(tetrahedron_edges[e][0]) && is_corner(tetrahedron_edges[e][1]))
        used[mesh.mid_edge_nodes[f.tetrahedron][e]] = true;
  }
  std::vector<std::uint32_t> nodes;
  for (std::size_t n = 0; n < used.size(); ++n)
    if (used[n]) nodes.push_back(static_cast<std::uint32_t>(n));
  return nodes;
}

std::vector<BoundaryFace> find_boundary(const std::vector<Tetrahedron>& tetrahedra) {
  return find_element_faces(tetrahedra).boundary;
}

SurfaceMesh boundary_surface(const TetMesh& mesh) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.outer_faces());
  for (std::size_t i = 0; i < mesh.outer_faces(); ++i) triangles.push_back(boundary_triangle(mesh, mesh.boundary[i]));
  return numbered_in_order(mesh, std::move(triangles));
}

SurfaceMesh surfaces_of_bodies(const TetMesh& mesh) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.boundary.size() + mesh.faces_between);
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    const auto [a, b, c] = boundary_triangle(mesh, mesh.boundary[i]);
    triangles.push_back({a, b, c});
    if (i >= mesh.outer_faces()) triangles.push_back({a, c, b});
  }
  return numbered_in_order(mesh, std::move(triangles));
}

CurvedTetrahedron curved_tetrahedron(const TetMesh& mesh, std::size_t tetrahedron) {
  CurvedTetrahedron nodes;
  for (std::size_t i = 0; i < 4; ++i) nodes[i] = mesh.nodes[mesh.tetrahedra[tetrahedron][i]];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto& [i, j] = tetrahedron_edges[e];
    nodes[4 + e] = mesh.order() == 2
                       ? mesh.nodes[mesh.mid_edge_nodes[tetrahedron][e]]
                       : Vec3(0.5 * (nodes[static_cast<std::size_t>(i)] + nodes[static_cast<std::size_t>(j)]));
  }
  return nodes;
}

std::array<Vec3, 3> derivatives_at(const CurvedTetrahedron& nodes, const std::array<double, 4>& b) {
  // By each of the four, taken as independent; from the first corner, so that far-off coordinates cost no digits.
  std::array<Vec3, 4> d;
  for (std::size_t i = 0; i < 4; ++i) d[i] = (4 * b[i] - 1) * (nodes[i] - nodes[0]);
  for (std::size_t e = 0; e < 6; ++e) {
    const auto i = static_cast<std::size_t>(tetrahedron_edges[e][0]),
               j = static_cast<std::size_t>(tetrahedron_edges[e][1]);
    const Vec3 node = nodes[4 + e] - nodes[0];
    d[i] += 4 * b[j] * node;
    d[j] += 4 * b[i] * node;
  }
  return {d[1] - d[0], d[2] - d[0], d[3] - d[0]};
}

double volume_of(const CurvedTetrahedron& nodes) {
  // The Jacobian is a cubic polynomial, which the rule of five points integrates exactly.
  const auto jacobian = [&](const std::array<double, 4>& b) {
    const auto [u, v, w] = derivatives_at(nodes, b);
    return u.cross(v).dot(w);
  };
  double sum = -0.8 * jacobian({0.25, 0.25, 0.25, 0.25});
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<double, 4> b{1.0 / 6, 1.0 / 6, 1.0 / 6, 1.0 / 6};
    b[k] = 0.5;
    sum += 0.45 * jacobian(b);
  }
  return sum / 6;
}

double volume_of(const TetMesh& mesh, std::span<const std::uint32_t> tetrahedra) {
  double sum = 0;
  for (const std::uint32_t t : tetrahedra) sum += volume_of(mesh, t);
  return sum;
}

double total_volume(const TetMesh& mesh) {
  double volume = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tetrahedra[t];
    const Vec3& p = mesh.nodes[a];
    volume += mesh.order() == 2 ? volume_of(curved_tetrahedron(mesh, t))
                                : (mesh.nodes[b] - p).cross(mesh.nodes[c] - p).dot(mesh.nodes[d] - p) / 6;
  }
  return volume;
}

}  // namespace scan2fea
