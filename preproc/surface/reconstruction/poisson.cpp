#include "preproc/surface/reconstruction/poisson.hpp"

#include "preproc/surface/kernel/spatial_order.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/poisson_surface_reconstruction.h>
#include <CGAL/property_map.h>

#include <utility>

namespace scan2fea {

SurfaceMesh poisson_surface(const std::vector<Vec3>& points, const std::vector<Vec3>& normals, double spacing) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Oriented = std::pair<Kernel::Point_3, Kernel::Vector_3>;
  std::vector<Oriented> oriented;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 &p = points[i], n = normals[i].normalized();
    oriented.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), Kernel::Vector_3(n.x(), n.y(), n.z()));
  }
  CGAL::get_default_random() = CGAL::Random(1);  // not the time
  CGAL::Surface_mesh<Kernel::Point_3> made;
  SurfaceMesh mesh;
  constexpr double least_angle_deg = 20, largest_radius = 1, largest_distance = 0.1;  // lengths in spacings
  if (!CGAL::poisson_surface_reconstruction_delaunay(oriented.begin(), oriented.end(),
                                                     CGAL::First_of_pair_property_map<Oriented>(),
                                                     CGAL::Second_of_pair_property_map<Oriented>(), made, spacing,
                                                     least_angle_deg, largest_radius, largest_distance))
    return mesh;
  for (const auto v : made.vertices()) {
    const Kernel::Point_3& p = made.point(v);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : made.faces()) {
    Triangle& t = mesh.triangles.emplace_back();
    std::size_t i = 0;
    for (const auto v : made.vertices_around_face(made.halfedge(f))) t[i++] = v.idx();
  }
  order_along_curve(mesh);  // where only their order differs they are the same
  return mesh;
}

}  // namespace scan2fea
