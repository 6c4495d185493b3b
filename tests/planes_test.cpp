// Plane faces of scans, and of the meshes made of them.
#include "preproc/pipeline.hpp"
#include "preproc/surface/features/planes_of_scan.hpp"
#include "preproc/surface/features/scan_noise.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "quality/triangle_tree.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/machined_part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace scan2fea {
namespace {

PlaneRegions regions_of(const SurfaceMesh& scan, double edge) {
  return find_plane_regions(scan, estimate_noise(scan, MeshAdjacency(scan)), edge);
}

TEST(PlaneRegions, OfABoxAreItsSides) {
  for (const double noise : {0.0, 0.002, 0.01}) {
    const SurfaceMesh box = analytic::box({4, 3, 2}, 0.1);
    const SurfaceMesh scan = analytic::noisy(box, noise, 5);
    const PlaneRegions regions = regions_of(scan, 0.3);
    ASSERT_EQ(regions.list.size(), 6) << noise;
    for (std::size_t f = 0; f < box.triangles.size(); ++f) {
      const Vec3 side = area_vector(box, box.triangles[f]).normalized();
      const Vec3 from_edge = Vec3(2, 1.5, 1) - (centroid(box, box.triangles[f]) - Vec3(2, 1.5, 1)).cwiseAbs();
      std::array<double, 3> rest{from_edge.x(), from_edge.y(), from_edge.z()};
      std::ranges::sort(rest);
      if (rest[1] < 0.1) continue;  // within an edge of the border
      const std::uint32_t region = regions.of_triangle[f];
      ASSERT_NE(region, no_plane) << noise << ": " << centroid(box, box.triangles[f]).transpose();
      EXPECT_LT(regions.list[region].normal.cross(side).norm(), noise + 1e-12);
    }
  }
}

TEST(PlaneRegions, OfWhatIsRoundAreNone) {
  for (const double noise : {0.0, 0.001, 0.01}) {
    EXPECT_TRUE(regions_of(analytic::noisy(analytic::sphere(1, 5), noise, 1), 0.2).list.empty()) << noise;
    EXPECT_TRUE(regions_of(analytic::noisy(analytic::torus(2, 0.7, 120, 60), noise, 2), 0.2).list.empty()) << noise;
  }
  EXPECT_EQ(regions_of(analytic::cylinder(1, 3, 32, 1), 0.3).list.size(), 2U) << "long facets are no faces";
}

// A plate that is bent by half a per cent of its width, ten times the noise.
TEST(PlaneRegions, AWarpedPlateStaysAsItIs) {
  SurfaceMesh plate = analytic::box({4, 4, 0.5}, 0.1);
  for (Vec3& p : plate.vertices) p.z() += 0.01 * std::pow(p.x() - 2, 2) / 2;
  for (const Plane& plane : regions_of(analytic::noisy(plate, 0.001, 3), 0.3).list)
    EXPECT_LT(std::abs(plane.normal.z()), 0.1);
}

// How far corners and mid-edge nodes of the boundary are from the planes that they stand for: faces whose corners lie
// above one plane of the drawing alone.
class PlanesOfAPart : public testing::TestWithParam<std::tuple<double, int>> {
 protected:
  struct Distances {
    std::vector<double> of_corners, of_mids;
  };

  Distances distances(const TetMesh& mesh, const analytic::MachinedPart& exact) const {
    std::map<std::uint32_t, std::vector<std::uint32_t>> triangles;
    for (std::uint32_t f = 0; f < exact.face_of_triangle.size(); ++f)
      if (exact.faces[exact.face_of_triangle[f]].kind == "plane") triangles[exact.face_of_triangle[f]].push_back(f);
    Distances found;
    for (const auto& [face, of_face] : triangles) {
      const TriangleTree tree(exact.scan, of_face);
      const Triangle& largest = exact.scan.triangles[*std::ranges::max_element(
          of_face, {}, [&](std::uint32_t f) { return area_vector(exact.scan, exact.scan.triangles[f]).norm(); })];
      const Vec3 normal = area_vector(exact.scan, largest).normalized(), point = exact.scan.vertices[largest[0]];
      const auto stands_for = [&](const Vec3& p) {
        const Vec3 away = p - tree.closest(p).point;
        return std::abs(away.dot(normal)) < 0.3 && (away - away.dot(normal) * normal).norm() < 1e-6;
      };
      for (const BoundaryFace& boundary : mesh.boundary) {
        const Triangle corners = boundary_triangle(mesh, boundary);
        const Vec3 a = mesh.nodes[corners[0]], b = mesh.nodes[corners[1]], c = mesh.nodes[corners[2]];
        if ((b - a).cross(c - a).normalized().dot(normal) < 0.9) continue;
        if (!stands_for(a) || !stands_for(b) || !stands_for(c)) continue;
        const auto height = [&](std::uint32_t node) { return std::abs((mesh.nodes[node] - point).dot(normal)); };
        for (const std::uint32_t node : corners) found.of_corners.push_back(height(node));
        if (mesh.order() == 1) continue;
        for (const std::uint32_t node : boundary_mid_edge_nodes(mesh, boundary)) found.of_mids.push_back(height(node));
      }
    }
    return found;
  }
};

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST_P(PlanesOfAPart, ArePlaneInTheMesh) {
  const auto [noise, order] = GetParam();
  constexpr double edge = 1.2, diagonal = 99;
  const analytic::MachinedPart exact = analytic::machined_part(edge, 0), part = analytic::machined_part(edge, noise);
  PipelineOptions options;
  options.order = order;
  const PipelineResult result = run_pipeline(part.scan, options);
  const Distances found = distances(*result.volume_mesh, exact);
  ASSERT_GT(found.of_corners.size(), 1000U);
  for (const std::vector<double>* of : {&found.of_corners, &found.of_mids}) {
    if (of->empty()) continue;
    if (noise == 0)
      EXPECT_LT(std::ranges::max(*of), 1e-9 * diagonal);
    else
      EXPECT_LT(root_mean_square(*of), 0.1 * noise * diagonal);
  }
  EXPECT_EQ(found.of_mids.empty(), order == 1);
}

INSTANTIATE_TEST_SUITE_P(NoiseAndOrder, PlanesOfAPart,
                         testing::Combine(testing::Values(0.0, 0.0002), testing::Values(1, 2)));

}  // namespace
}  // namespace scan2fea
