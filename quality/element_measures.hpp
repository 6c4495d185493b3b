// Each element's own figures, of which the report's histograms, its view and its list of the worst are made.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/mesh/tet_mesh.hpp"
#include "quality/histogram.hpp"

#include <vector>

namespace scan2fea {

// What has no value, as the shape of a triangle without area, is NaN.
struct ElementMeasures {
  // The surface; of a volume mesh all its nodes, and its outer boundary in the order of TetMesh::boundary.
  SurfaceMesh faces;
  std::vector<double> face_edge_ratio, face_min_angle_deg, face_max_angle_deg;
  // Per tetrahedron; none of a surface. See TetShape.
  std::vector<double> scaled_jacobian, min_dihedral_deg, max_dihedral_deg, edge_ratio;
  // Per face, and per triangle of the reference; see signed_deviation.hpp. None without a reference; of one that is
  // points, none of its own.
  std::vector<double> deviation, deviation_of_reference;

  bool is_volume() const { return !scaled_jacobian.empty(); }
};

// `points`: what deviations are from where there is no reference. O(n), or O(n log n) with one of them; parallel, the
// same for any number of threads.
ElementMeasures measure_elements(const SurfaceMesh& mesh, const SurfaceMesh* reference,
                                 const std::vector<Vec3>* points = nullptr);
ElementMeasures measure_elements(const TetMesh& mesh, const SurfaceMesh* reference,
                                 const std::vector<Vec3>* points = nullptr);

// Those that there are, in the order in which a report shows them.
std::vector<MeasuredElements> histograms_of(const ElementMeasures& measures);

}  // namespace scan2fea
