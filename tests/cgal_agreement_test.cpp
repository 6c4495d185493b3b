// The figures of quality/ against the same figures from CGAL, on real scans and on rough copies of them that have
// slivers and pass through themselves.
#include "preproc/mesh/read_surface.hpp"
#include "quality/report.hpp"
#include "quality/self_intersections.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/scans.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace scan2fea {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using CgalMesh = CGAL::Surface_mesh<Point>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<CgalMesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

CgalMesh to_cgal(const SurfaceMesh& mesh) {
  CgalMesh result;
  for (const Vec3& v : mesh.vertices) result.add_vertex(Point(v.x(), v.y(), v.z()));
  for (const auto& [a, b, c] : mesh.triangles)
    result.add_face(CgalMesh::Vertex_index(a), CgalMesh::Vertex_index(b), CgalMesh::Vertex_index(c));
  return result;
}

std::array<Point, 3> corners(const CgalMesh& mesh, CgalMesh::Face_index f) {
  const auto h = mesh.halfedge(f);
  return {mesh.point(mesh.source(h)), mesh.point(mesh.target(h)), mesh.point(mesh.target(mesh.next(h)))};
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void expect_equal(double value, double expected, const char* name) {
  EXPECT_NEAR(value, expected, 1e-6 * std::abs(expected)) << name;
}

void compare_shapes(const TriangleSummary& summary, const CgalMesh& mesh) {
  std::vector<double> edge_ratio, min_angle, max_angle, radius_ratio;
  for (const auto f : mesh.faces()) {
    const auto [a, b, c] = corners(mesh, f);
    const auto [shortest, longest] =
        std::minmax({CGAL::squared_distance(a, b), CGAL::squared_distance(b, c), CGAL::squared_distance(c, a)});
    edge_ratio.push_back(std::sqrt(longest / shortest));
    const auto angles = {CGAL::approximate_angle(a, b, c), CGAL::approximate_angle(b, c, a),
                         CGAL::approximate_angle(c, a, b)};
    min_angle.push_back(std::min(angles));
    max_angle.push_back(std::max(angles));
    const double area = std::sqrt(CGAL::squared_area(a, b, c));
    const double perimeter = CGAL::approximate_sqrt(CGAL::squared_distance(a, b)) +
                             CGAL::approximate_sqrt(CGAL::squared_distance(b, c)) +
                             CGAL::approximate_sqrt(CGAL::squared_distance(c, a));
    const double inscribed = 2 * area / perimeter;
    const double circumscribed =
        std::sqrt(CGAL::squared_distance(a, b) * CGAL::squared_distance(b, c) * CGAL::squared_distance(c, a)) /
        (4 * area);
    radius_ratio.push_back(2 * inscribed / circumscribed);
  }
  std::sort(edge_ratio.begin(), edge_ratio.end());
  const auto at = [&](double p) { return edge_ratio[static_cast<std::size_t>(p * double(edge_ratio.size()))]; };
  EXPECT_EQ(summary.measured, edge_ratio.size());
  expect_equal(summary.edge_ratio.mean, mean(edge_ratio), "edge_ratio.mean");
  expect_equal(summary.edge_ratio.p50, at(0.5), "edge_ratio.p50");
  expect_equal(summary.edge_ratio.p95, at(0.95), "edge_ratio.p95");
  expect_equal(summary.edge_ratio.p99, at(0.99), "edge_ratio.p99");
  expect_equal(summary.edge_ratio.max, edge_ratio.back(), "edge_ratio.max");
  expect_equal(summary.min_angle_deg.mean, mean(min_angle), "min_angle.mean");
  expect_equal(summary.min_angle_deg.min, *std::min_element(min_angle.begin(), min_angle.end()), "min_angle.min");
  expect_equal(summary.max_angle_deg, *std::max_element(max_angle.begin(), max_angle.end()), "max_angle");
  expect_equal(summary.radius_ratio.mean, mean(radius_ratio), "radius_ratio.mean");
  expect_equal(summary.radius_ratio.min, *std::min_element(radius_ratio.begin(), radius_ratio.end()),
               "radius_ratio.min");
}

void compare_topology(const SurfaceFigures& surface, CgalMesh& mesh) {
  auto component = mesh.add_property_map<CgalMesh::Face_index, std::size_t>("f:component", 0).first;
  EXPECT_EQ(surface.validity.components, PMP::connected_components(mesh, component));
  EXPECT_EQ(surface.validity.closed(), CGAL::is_closed(mesh));
  EXPECT_TRUE(surface.validity.manifold());
  std::size_t isolated = 0;
  for (const auto v : mesh.vertices()) isolated += mesh.is_isolated(v);
  EXPECT_EQ(surface.validity.unused_vertices, isolated);
  if (CGAL::is_closed(mesh)) {
    const long euler =
        long(mesh.number_of_vertices() - isolated) - long(mesh.number_of_edges()) + long(mesh.number_of_faces());
    EXPECT_EQ(2 * long(surface.validity.components) - 2 * *surface.validity.genus, euler);
    expect_equal(*surface.volume, CGAL::to_double(PMP::volume(mesh)), "volume");
  }
  expect_equal(surface.area, CGAL::to_double(PMP::area(mesh)), "area");
}

void compare_self_intersections(const SurfaceMesh& mesh, const CgalMesh& cgal_mesh) {
  std::vector<std::pair<CgalMesh::Face_index, CgalMesh::Face_index>> found;
  PMP::self_intersections(cgal_mesh, std::back_inserter(found));
  std::vector<FacePair> expected;
  for (const auto& [f, g] : found) expected.push_back({std::min<std::uint32_t>(f, g), std::max<std::uint32_t>(f, g)});
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(find_self_intersections(mesh), expected);
}

struct Side {
  double largest, rms;
};

Side distances(const CgalMesh& from, const CgalMesh& to) {
  std::vector<Point> points(from.points().begin(), from.points().end());
  PMP::sample_triangle_mesh(
      from, std::back_inserter(points),
      CGAL::parameters::number_of_points_on_faces(200'000).do_sample_vertices(false).do_sample_edges(false));
  const Tree tree(faces(to).first, faces(to).second, to);
  double largest = 0, sum = 0;
  for (const Point& p : points) {
    const double squared = tree.squared_distance(p);
    largest = std::max(largest, squared);
    sum += squared;
  }
  return {std::sqrt(largest), std::sqrt(sum / double(points.size()))};
}

void compare_deviation(const SurfaceMesh& mesh, const SurfaceMesh& reference, const CgalMesh& cgal_mesh,
                       const CgalMesh& cgal_reference) {
  const Deviation deviation = measure_deviation(mesh, reference);
  const Side there = distances(cgal_mesh, cgal_reference), back = distances(cgal_reference, cgal_mesh);
  const double diagonal = bounding_box(reference.vertices).diagonal();
  const double hausdorff = 100 * std::max(there.largest, back.largest) / diagonal;
  const double rms = 100 * std::max(there.rms, back.rms) / diagonal;
  EXPECT_NEAR(deviation.hausdorff_pct_diagonal, hausdorff, 0.02 * hausdorff);
  EXPECT_NEAR(deviation.rms_pct_diagonal, rms, 0.02 * rms);
  if (deviation.volume_difference_pct) {
    const double volume = PMP::volume(cgal_mesh), reference_volume = PMP::volume(cgal_reference);
    EXPECT_NEAR(*deviation.volume_difference_pct, 100 * (volume - reference_volume) / reference_volume, 1e-6);
  }
}

class CgalAgreement : public testing::TestWithParam<const char*> {};

TEST_P(CgalAgreement, OnTheScanAndARoughCopyOfIt) {
  const SurfaceMesh mesh = read_surface(scan(GetParam()));
  const double triangle_size = std::sqrt(surface_area(mesh) / static_cast<double>(mesh.triangles.size()));
  const SurfaceMesh rough = analytic::noisy(mesh, 0.4 * triangle_size, 1);
  CgalMesh cgal_mesh = to_cgal(mesh), cgal_rough = to_cgal(rough);
  ASSERT_EQ(cgal_mesh.number_of_faces(), mesh.triangles.size());

  const SurfaceFigures figures = measure_surface(mesh), rough_figures = measure_surface(rough);
  compare_shapes(figures.shape, cgal_mesh);
  compare_shapes(rough_figures.shape, cgal_rough);
  compare_topology(figures, cgal_mesh);
  compare_topology(rough_figures, cgal_rough);
  compare_self_intersections(mesh, cgal_mesh);
  compare_self_intersections(rough, cgal_rough);
  EXPECT_GT(rough_figures.self_intersections, 100U);  // or the comparison says little
  compare_deviation(rough, mesh, cgal_rough, cgal_mesh);
}

// Large and closed; open; with creases; and those that cross themselves.
INSTANTIATE_TEST_SUITE_P(Scans, CgalAgreement,
                         testing::Values("bunny00.off", "lion.off", "fandisk.off", "camel.off",
                                         "ChineseDragon-10kv.off"));

}  // namespace
}  // namespace scan2fea
