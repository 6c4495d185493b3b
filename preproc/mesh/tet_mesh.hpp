// The tetrahedral mesh that is exported to solvers.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/six_node_triangle.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scan2fea {

using Tetrahedron = std::array<std::uint32_t, 4>;
using MidEdgeNodes = std::array<std::uint32_t, 6>;

// Edges of a tetrahedron in the order of the mid-edge nodes of Abaqus, CalculiX, Nastran and VTK: 12 23 13 14 24 34.
// Gmsh swaps the last two; the exporter does that, nothing else needs to know.
inline constexpr std::array<std::array<int, 2>, 6> tetrahedron_edges{{{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

// Faces of a tetrahedron in Abaqus's order S1 = 1-2-3, S2 = 1-4-2, S3 = 2-4-3, S4 = 3-4-1. Seen from outside a
// positive tetrahedron these are clockwise; `boundary_triangle` gives them counter-clockwise.
inline constexpr std::array<std::array<int, 3>, 4> tetrahedron_faces{{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};

struct BoundaryFace {
  std::uint32_t tetrahedron;  // the element behind the face
  std::uint8_t face;          // 0..3, an index into tetrahedron_faces
};

// Nodes are in model units. The corner nodes of the boundary come first and in the order of the surface's vertices
// (unless the mesher was allowed to split the boundary), then interior corners, then mid-edge nodes.
// A tetrahedron (a, b, c, d) is positive: (b - a) x (c - a) . (d - a) > 0, as every solver here wants it.
struct TetMesh {
  std::vector<Vec3> nodes;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<MidEdgeNodes> mid_edge_nodes;  // empty for first order, one per tetrahedron for second order
  // In the order of the surface's triangles. The last `faces_between` of it lie within, between two elements, each once
  // as the face of one of them: where two bodies meet. Each of these is in a set.
  std::vector<BoundaryFace> boundary;
  std::size_t faces_between = 0;
  std::vector<NamedSet> node_sets;
  std::vector<NamedSet> face_sets;     // of `boundary`; a writer derives their nodes (nodes_of_faces)
  std::vector<NamedSet> element_sets;  // bodies, materials
  std::string unit;                    // of length, as in the file or as given; empty where it is not known

  std::size_t outer_faces() const { return boundary.size() - faces_between; }
  int order() const { return mid_edge_nodes.empty() ? 1 : 2; }
};

// The corner nodes of a boundary face, counter-clockwise seen from outside.
inline Triangle boundary_triangle(const TetMesh& mesh, BoundaryFace f) {
  const auto& tet = mesh.tetrahedra[f.tetrahedron];
  const auto& local = tetrahedron_faces[f.face];
  return {tet[static_cast<std::size_t>(local[0])], tet[static_cast<std::size_t>(local[2])],
          tet[static_cast<std::size_t>(local[1])]};
}

// The nodes in the middle of the edges of `boundary_triangle`: 12, 23, 31. Precondition: the mesh is of second order.
Triangle boundary_mid_edge_nodes(const TetMesh& mesh, BoundaryFace f);

// A boundary face of any order, its corners those of `boundary_triangle`; of first order the nodes between them are
// where straight edges have their middles.
SixNodeTriangle boundary_face_nodes(const TetMesh& mesh, BoundaryFace f);

// Of the face as it is: of second order curved.
double face_area(const TetMesh& mesh, BoundaryFace f);

// The integral of its normal, outwards: what a pressure pushes against, less its sign. Exact.
Vec3 face_vector_area(const TetMesh& mesh, BoundaryFace f);

// All nodes of boundary faces, those in the middle of their edges too; sorted.
std::vector<std::uint32_t> nodes_of_faces(const TetMesh& mesh, std::span<const std::uint32_t> faces);

// The faces that belong to exactly one tetrahedron, ordered by tetrahedron and face. O(n log n).
std::vector<BoundaryFace> find_boundary(const std::vector<Tetrahedron>& tetrahedra);

// Corner nodes and triangles of the boundary; vertices are renumbered in the order of the nodes.
SurfaceMesh boundary_surface(const TetMesh& mesh);

// The same with the faces between two bodies, once for either: the closed surfaces of all bodies.
SurfaceMesh surfaces_of_bodies(const TetMesh& mesh);

// An element of any order: corners, then nodes in the middle of the edges in the order of `tetrahedron_edges`.
using CurvedTetrahedron = std::array<Vec3, 10>;

CurvedTetrahedron curved_tetrahedron(const TetMesh& mesh, std::size_t tetrahedron);

// Of the position by the second, third and fourth barycentric coordinate, at the point with these four.
std::array<Vec3, 3> derivatives_at(const CurvedTetrahedron& nodes, const std::array<double, 4>& barycentric);

// Exact; negative where it is inside out.
double volume_of(const CurvedTetrahedron& nodes);
inline double volume_of(const TetMesh& mesh, std::size_t tetrahedron) {
  return volume_of(curved_tetrahedron(mesh, tetrahedron));
}

// Of these elements.
double volume_of(const TetMesh& mesh, std::span<const std::uint32_t> tetrahedra);

// Sum over the elements as they are: of second order curved.
double total_volume(const TetMesh& mesh);

}  // namespace scan2fea
