#include "preproc/surface/repair/wrap.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

namespace scan2fea {

void wrap(SurfaceMesh& mesh, RepairResult& result) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  constexpr double ball_of_diagonal = 1.0 / 50, distance_of_diagonal = 1.0 / 600;
  const BoundingBox box = bounding_box(mesh.vertices);
  std::vector<Point> points;
  for (const Vec3& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  for (const Triangle& t : mesh.triangles)
    if (!CGAL::collinear(points[t[0]], points[t[1]], points[t[2]])) faces.push_back({t[0], t[1], t[2]});
  if (faces.empty())  // which CGAL is not made for
    throw NotMeshable({.what = "nothing to wrap: no face has an area",
                       .where = error_text((box.low + box.high) / 2),
                       .value = std::to_string(mesh.triangles.size()) + " faces",
                       .limit = {},
                       .advice = "a scan of all sides of the part"});
  CGAL::Surface_mesh<Point> wrapped;
  CGAL::alpha_wrap_3(points, faces, ball_of_diagonal * box.diagonal(), distance_of_diagonal * box.diagonal(), wrapped);

  result.faces_removed += mesh.triangles.size();
  mesh = {};
  for (const auto v : wrapped.vertices()) {
    const Point& p = wrapped.point(v);
    mesh.vertices.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : wrapped.faces()) {
    Triangle& t = mesh.triangles.emplace_back();
    std::size_t i = 0;
    for (const auto v : wrapped.vertices_around_face(wrapped.halfedge(f))) t[i++] = v.idx();
  }
  result.faces_added += mesh.triangles.size();
  result.changes.push_back(
      {RepairKind::Wrapped, (box.low + box.high) / 2, distance_of_diagonal * box.diagonal(), surface_area(mesh)});
}

}  // namespace scan2fea
