// A mesh with all that a format may keep: sets of each kind, two bodies and a unit.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"
#include "tests/structured_tets.hpp"

#include <algorithm>

namespace scan2fea::analytic {

// The faces of the boundary all of whose corners have this x, to the bit.
inline std::vector<std::uint32_t> boundary_faces_at(const TetMesh& mesh, double x) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < mesh.boundary.size(); ++f) {
    const Triangle t = boundary_triangle(mesh, mesh.boundary[f]);
    if (std::all_of(t.begin(), t.end(), [&](std::uint32_t n) { return mesh.nodes[n].x() == x; })) faces.push_back(f);
  }
  return faces;
}

// A box of 4 x 2 x 1, from the origin, in millimetres: faces FIXED at x = 0 and LOADED at x = 4, nodes PINS, bodies
// BRACKET (x < 2) and PIN. `cells`: cubes along each edge, of an even number in x.
inline TetMesh part_with_sets(int order, const std::array<int, 3>& cells = {4, 2, 1}) {
  TetMesh mesh = tetrahedra_of_box({4, 2, 1}, cells, order);
  mesh.boundary = find_boundary(mesh.tetrahedra);
  mesh.face_sets = {named_set("FIXED", boundary_faces_at(mesh, 0)), named_set("LOADED", boundary_faces_at(mesh, 4))};
  mesh.node_sets = {named_set("PINS", {0, 3, 7})};
  std::vector<std::uint32_t> left, right;
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    double x = 0;
    for (const std::uint32_t n : mesh.tetrahedra[t]) x += mesh.nodes[n].x() / 4;
    (x < 2 ? left : right).push_back(t);
  }
  mesh.element_sets = {named_set("BRACKET", left), named_set("PIN", right)};
  mesh.unit = "mm";
  return mesh;
}

}  // namespace scan2fea::analytic
