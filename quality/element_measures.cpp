#include "quality/element_measures.hpp"

#include "quality/curved_surface.hpp"
#include "quality/signed_deviation.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "quality/triangle_measures.hpp"

#include <tbb/parallel_for.h>

#include <limits>

namespace scan2fea {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

void measure_faces(ElementMeasures& measures) {
  const SurfaceMesh& mesh = measures.faces;
  for (auto* values : {&measures.face_edge_ratio, &measures.face_min_angle_deg, &measures.face_max_angle_deg})
    values->assign(mesh.triangles.size(), none);
  tbb::parallel_for(std::size_t{0}, mesh.triangles.size(), [&](std::size_t f) {
    const auto& [a, b, c] = mesh.triangles[f];
    const auto shape = measure_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    if (!shape) return;
    measures.face_edge_ratio[f] = shape->edge_ratio;
    measures.face_min_angle_deg[f] = shape->min_angle_deg;
    measures.face_max_angle_deg[f] = shape->max_angle_deg;
  });
}

void measure_volume(const TetMesh& mesh, ElementMeasures& measures) {
  const std::size_t n = mesh.tetrahedra.size();
  for (auto* values :
       {&measures.scaled_jacobian, &measures.min_dihedral_deg, &measures.max_dihedral_deg, &measures.edge_ratio})
    values->resize(n);
  tbb::parallel_for(std::size_t{0}, n, [&](std::size_t t) {
    const TetShape shape = measure_tetrahedron(mesh, t);
    measures.scaled_jacobian[t] = shape.scaled_jacobian;
    measures.min_dihedral_deg[t] = shape.min_dihedral_deg;
    measures.max_dihedral_deg[t] = shape.max_dihedral_deg;
    measures.edge_ratio[t] = shape.edge_ratio.value_or(none);
  });
}

// `surface`: the mesh's, in flat triangles.
template <class Mesh>
void measure_deviations(const Mesh& mesh, const SurfaceMesh& surface, const SurfaceMesh& reference,
                        ElementMeasures& measures) {
  measures.deviation = signed_deviations(mesh, TriangleTree(reference));
  measures.deviation_of_reference = signed_deviations_of_reference(reference, surface, TriangleTree(surface));
}

}  // namespace

ElementMeasures measure_elements(const SurfaceMesh& mesh, const SurfaceMesh* reference,
                                 const std::vector<Vec3>* points) {
  ElementMeasures measures;
  measures.faces = mesh;
  measure_faces(measures);
  if (reference != nullptr)
    measure_deviations(mesh, mesh, *reference, measures);
  else if (points != nullptr)
    measures.deviation = signed_deviations_from_points(*points, mesh);
  return measures;
}

ElementMeasures measure_elements(const TetMesh& mesh, const SurfaceMesh* reference, const std::vector<Vec3>* points) {
  ElementMeasures measures;
  measures.faces = outer_corner_faces(mesh);
  measure_faces(measures);
  measure_volume(mesh, measures);
  if (reference != nullptr && mesh.order() == 2) {
    const double tolerance = flat_enough_of_diagonal * bounding_box(reference->vertices).diagonal();
    measure_deviations(mesh, flat_pieces(mesh, tolerance).mesh, *reference, measures);
  } else if (reference != nullptr) {
    measure_deviations(mesh, measures.faces, *reference, measures);
  } else if (points != nullptr) {
    measures.deviation = signed_deviations_from_points(*points, mesh);
  }
  return measures;
}

std::vector<MeasuredElements> histograms_of(const ElementMeasures& measures) {
  std::vector<MeasuredElements> list;
  const auto add = [&](const char* measure, const char* of, const std::vector<double>& values, const BarScale& scale) {
    if (!values.empty()) list.push_back(count_elements(measure, of, values, scale));
  };
  constexpr double no_scanner_sees = 1e-6;  // of the diagonal
  const double least = no_scanner_sees * bounding_box(measures.faces.vertices).diagonal();
  add("deviation", "triangles", measures.deviation, scale_around_zero(measures.deviation, least > 0 ? least : 1));
  add("edge_ratio", "triangles", measures.face_edge_ratio, {.low = 1, .high = 3, .bars = 40});
  add("min_angle_deg", "triangles", measures.face_min_angle_deg, {.low = 0, .high = 60, .bars = 30});
  add("scaled_jacobian", "tetrahedra", measures.scaled_jacobian, {.low = 0, .high = 1, .bars = 40});
  add("min_dihedral_deg", "tetrahedra", measures.min_dihedral_deg, {.low = 0, .high = 75, .bars = 30});
  add("max_dihedral_deg", "tetrahedra", measures.max_dihedral_deg, {.low = 60, .high = 180, .bars = 40});
  add("edge_ratio", "tetrahedra", measures.edge_ratio, {.low = 1, .high = 4, .bars = 30});
  return list;
}

}  // namespace scan2fea
