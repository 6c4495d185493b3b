// Shape of tetrahedra, in the measures of Verdict (Stimpson et al., "The Verdict geometric quality library", 2007).
//
// The figures of a second-order element are those of the curved element; where its edges are straight and its nodes in
// their middles, those of its corners. The scaled Jacobian is the smallest over the whole element, by a lower bound
// (jacobian_bound.hpp) over the longest edges at a corner; dihedral angles are those between the tangent planes of the
// faces at the ends and in the middle of each edge; edges are as long as their curves. The radius-edge ratio is that of
// the corners, since no sphere goes through ten nodes: it is a figure of how points lie, not of how good an element is.
//
// Every figure is finite. Dihedral angles of a flat tetrahedron are 0 or 180, its scaled Jacobian is 0; its
// circumscribed radius is infinite and its edge ratio may be, so tetrahedra without volume enter neither of these two,
// and are counted in `inverted`.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <cstddef>
#include <optional>

namespace scan2fea {

struct TetShape {
  double min_dihedral_deg;  // 70.5288 for a regular tetrahedron; of the geometric shape, whatever its orientation
  double max_dihedral_deg;
  double scaled_jacobian;                   // sqrt(2) * J / the largest l1 l2 l3 of a corner; regular 1, inverted < 0
  std::optional<double> edge_ratio;         // longest edge / shortest edge; none without volume
  std::optional<double> radius_edge_ratio;  // circumscribed radius / shortest edge, regular 0.6124; none without volume
};

TetShape measure_tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// The smallest over the whole element, from below. About 2 us.
double curved_scaled_jacobian(const CurvedTetrahedron& nodes);

// Of an element of the mesh, of either order.
TetShape measure_tetrahedron(const TetMesh& mesh, std::size_t tetrahedron);

// The angles at the corners of its four faces, what Abaqus, Ansys and Nastran limit; of straight edges. Not among the
// shape, since they cost as much as all of it. An edge without length makes angles of 0.
struct FaceAngles {
  double min_deg, max_deg;  // 60 and 60 for a regular tetrahedron
};
FaceAngles measure_face_angles(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

struct TetSummary {
  std::size_t nodes = 0;
  std::size_t tetrahedra = 0;  // where it is 0, so are all figures
  int order = 1;
  double min_dihedral_deg = 0;
  double max_dihedral_deg = 0;
  double min_face_angle_deg = 0;  // see FaceAngles
  double max_face_angle_deg = 0;
  struct {
    double min = 0, mean = 0;
  } scaled_jacobian;
  double edge_ratio = 0;         // the largest
  double radius_edge_ratio = 0;  // the largest
  double volume = 0;             // of the elements as they are
  std::size_t inverted = 0;      // the Jacobian is not positive throughout
};

// O(n), parallel; the result does not depend on the number of threads.
TetSummary measure_tetrahedra(const TetMesh& mesh);

}  // namespace scan2fea
