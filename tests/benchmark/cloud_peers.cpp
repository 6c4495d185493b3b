// cloud_peers PEER CLOUD OUT: what CGAL makes of a point cloud, for tests/benchmark/cloud_table. PEER is
//   advancing-front  a triangulation of the points as they are
//   poisson          Poisson's surface, its criteria relative to the points' average spacing
//   upsampling       edge-aware upsampling to three times the points, and then the advancing front
// The latter two need a normal with each point. Parameters are those of CGAL's examples.
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/read_cloud.hpp"
#include "preproc/mesh/write_surface.hpp"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/compute_average_spacing.h>
#include <CGAL/edge_aware_upsample_point_set.h>
#include <CGAL/poisson_surface_reconstruction.h>
#include <CGAL/property_map.h>

#include <array>
#include <cstdio>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace scan2fea;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Oriented = std::pair<Kernel::Point_3, Kernel::Vector_3>;
using PointOf = CGAL::First_of_pair_property_map<Oriented>;
using NormalOf = CGAL::Second_of_pair_property_map<Oriented>;

std::vector<Oriented> read(const std::string& file, bool with_normals) {
  const PointCloud cloud = read_cloud(file);
  if (with_normals && cloud.normals.empty()) throw std::runtime_error(file + " has no normals");
  std::vector<Oriented> points;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3 &p = cloud.points[i], n = with_normals ? cloud.normals[i] : Vec3(0, 0, 1);
    points.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), Kernel::Vector_3(n.x(), n.y(), n.z()));
  }
  return points;
}

SurfaceMesh advancing_front(const std::vector<Oriented>& points) {
  std::vector<Kernel::Point_3> places;
  for (const Oriented& point : points) places.push_back(point.first);
  std::vector<std::array<std::size_t, 3>> facets;
  CGAL::advancing_front_surface_reconstruction(places.begin(), places.end(), std::back_inserter(facets));
  SurfaceMesh mesh;
  for (const Kernel::Point_3& p : places) mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  for (const auto& [a, b, c] : facets)
    mesh.triangles.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  if (enclosed_volume(mesh) < 0)
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

double spacing_of(const std::vector<Oriented>& points) {
  return CGAL::compute_average_spacing<CGAL::Sequential_tag>(points, 6, CGAL::parameters::point_map(PointOf()));
}

SurfaceMesh poisson(const std::vector<Oriented>& points) {
  CGAL::get_default_random() = CGAL::Random(1);
  CGAL::Surface_mesh<Kernel::Point_3> made;
  if (!CGAL::poisson_surface_reconstruction_delaunay(points.begin(), points.end(), PointOf(), NormalOf(), made,
                                                     spacing_of(points)))
    throw std::runtime_error("CGAL's Poisson makes no surface of this");
  SurfaceMesh mesh;
  for (const auto v : made.vertices())
    mesh.vertices.emplace_back(made.point(v).x(), made.point(v).y(), made.point(v).z());
  for (const auto f : made.faces()) {
    Triangle& t = mesh.triangles.emplace_back();
    std::size_t i = 0;
    for (const auto v : made.vertices_around_face(made.halfedge(f))) t[i++] = v.idx();
  }
  return mesh;
}

SurfaceMesh upsampling(std::vector<Oriented> points) {
  std::vector<Oriented> added;
  CGAL::edge_aware_upsample_point_set<CGAL::Sequential_tag>(points, std::back_inserter(added),
                                                            CGAL::parameters::point_map(PointOf())
                                                                .normal_map(NormalOf())
                                                                .sharpness_angle(25)
                                                                .edge_sensitivity(0)
                                                                .neighbor_radius(3 * spacing_of(points))
                                                                .number_of_output_points(3 * points.size()));
  points.insert(points.end(), added.begin(), added.end());
  return advancing_front(points);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string peer = argc == 4 ? argv[1] : "";
  if (peer != "advancing-front" && peer != "poisson" && peer != "upsampling") {
    std::fprintf(stderr, "usage: cloud_peers advancing-front|poisson|upsampling CLOUD OUT\n");
    return 2;
  }
  try {
    const std::vector<Oriented> points = read(argv[2], peer != "advancing-front");
    write_surface(peer == "poisson"      ? poisson(points)
                  : peer == "upsampling" ? upsampling(points)
                                         : advancing_front(points),
                  argv[3]);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "cloud_peers: %s\n", e.what());
    return 1;
  }
}
