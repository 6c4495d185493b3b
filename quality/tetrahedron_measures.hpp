// Shape of tetrahedra, in the measures of Verdict (Stimpson et al., "The Verdict geometric quality library", 2007).
//
// The figures are those of the corner nodes, that is of the straight-edged tetrahedron; a second-order element has the
// same ones plus curved edges, which can turn it inside out though its corners are in order: for those see
// jacobian_bound.hpp, which `measure_tetrahedra` asks before it calls an element valid.
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
  double scaled_jacobian;            // sqrt(2) * smallest over the corners of J / (l1 l2 l3); regular 1, inverted < 0
  std::optional<double> edge_ratio;  // longest edge / shortest edge; none without volume
  std::optional<double> radius_edge_ratio;  // circumscribed radius / shortest edge, regular 0.6124; none without volume
};

TetShape measure_tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

struct TetSummary {
  std::size_t nodes = 0;
  std::size_t tetrahedra = 0;  // where it is 0, so are all figures
  int order = 1;
  double min_dihedral_deg = 0;
  double max_dihedral_deg = 0;
  struct {
    double min = 0, mean = 0;
  } scaled_jacobian;
  double edge_ratio = 0;         // the largest
  double radius_edge_ratio = 0;  // the largest
  double volume = 0;             // of the straight-edged tetrahedra
  std::size_t inverted = 0;      // volume <= 0, or second order and its Jacobian not positive throughout
};

// O(n), parallel; the result does not depend on the number of threads.
TetSummary measure_tetrahedra(const TetMesh& mesh);

}  // namespace scan2fea
