// The boundary of a mesh of second order, whose triangles are curved, as flat triangles that lie near it.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// Of six nodes: corners, then the middles of 12, 23 and 31.
struct CurvedTriangle {
  std::array<std::uint32_t, 6> nodes;
};

// Each curved triangle is cut into n^2 flat ones, whose corners lie on it. They are not joined to one another: where
// neighbours are cut differently, there are gaps of less than the tolerance.
struct FlatPieces {
  SurfaceMesh mesh;
  // Those of outer_faces_by_element, or of TetMesh::boundary where those between bodies are wanted.
  std::vector<CurvedTriangle> curved;
  std::vector<Vec3> nodes;                             // of the whole mesh
  std::vector<std::uint32_t> of_piece;                 // per flat triangle the curved one
  std::vector<std::array<Eigen::Vector2d, 3>> places;  // and its corners there: second and third coordinate

  // The point of the curved triangle whose place in the flat one has these barycentric coordinates.
  Vec3 on_curve(std::uint32_t piece, double first, double second) const;
};

// The boundary without the faces between bodies, by element and face: the order that any file of the mesh gives, so
// that sums over it, and samples of it, are those of the mesh that is read again.
std::vector<BoundaryFace> outer_faces_by_element(const TetMesh& mesh);

// The same faces by their corners alone, in the order of TetMesh::boundary, with all nodes of the mesh.
SurfaceMesh outer_corner_faces(const TetMesh& mesh);

// Precondition: the mesh is of second order. No point of a flat triangle is farther than `tolerance`, model units, from
// the curved one, unless that takes more than `most_cuts` along an edge; nor the other way round. Of the outside, or of
// all bodies, faces between two of them once for either. O(n + pieces).
inline constexpr int most_cuts = 16;
enum class FacesBetween { left_out, of_either };
FlatPieces flat_pieces(const TetMesh& mesh, double tolerance, FacesBetween between = FacesBetween::left_out);

// The same of any faces of its elements, in this order.
FlatPieces flat_pieces(const TetMesh& mesh, std::span<const BoundaryFace> faces, double tolerance);

// The same of any curved triangles.
FlatPieces flat_pieces(std::vector<Vec3> nodes, std::span<const CurvedTriangle> triangles, double tolerance);

// What is near enough for figures of a deviation: a hundredth of the distance at which meshes are made by default, of
// the diagonal of what they are compared with.
inline constexpr double flat_enough_of_diagonal = 2e-5;

}  // namespace scan2fea
