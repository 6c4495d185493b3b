#include "preproc/surface/enrichment/enrich.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/collapse/collapse.hpp"
#include "preproc/surface/enrichment/side_normals.hpp"
#include "preproc/surface/enrichment/surface_walk.hpp"
#include "preproc/surface/kernel/delaunay_flips.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_tree.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace scan2fea {
namespace {

constexpr Lifting all_liftings[] = {Lifting::triharmonic, Lifting::shepard, Lifting::modified_quadratic_shepard,
                                    Lifting::moving_least_squares, Lifting::hermite};

// A surface known by its equation: where the nearest point of it is, and where it was scanned badly.
struct Scan {
  const char* name;
  SurfaceMesh mesh;
  Vec3 (*project)(const Vec3&);
};

Vec3 onto_sphere(const Vec3& p) {
  return 2 * p.normalized();
}
Vec3 onto_torus(const Vec3& p) {
  const Vec3 ring = 3 * Vec3(p[0], p[1], 0).normalized();
  return ring + (p - ring).normalized();
}

// Thinned to a third of the spacing where x > 0; every vertex on the surface.
Scan thinned(const char* name, SurfaceMesh mesh, std::size_t faces, Vec3 (*project)(const Vec3&)) {
  CollapseOptions options{.target_faces = faces, .cost = CollapseCost::sized_length};
  for (const Vec3& p : mesh.vertices) options.sizing.push_back(p[0] > 0 ? 3 : 1);
  collapse(mesh, options);
  for (Vec3& p : mesh.vertices) p = project(p);
  return {name, std::move(mesh), project};
}

std::vector<Scan> scans() {
  return {thinned("sphere", analytic::sphere(2, 5), 3000, onto_sphere),
          thinned("torus", analytic::torus(3, 1, 150, 60), 3000, onto_torus)};
}

double rms_to_truth(const Scan& scan, const std::vector<Vec3>& points) {
  double sum = 0;
  for (const Vec3& p : points) sum += (scan.project(p) - p).squaredNorm();
  return std::sqrt(sum / static_cast<double>(points.size()));
}

std::vector<Vec3> new_points(const SurfaceMesh& before, const SurfaceMesh& after) {
  return {after.vertices.begin() + static_cast<std::ptrdiff_t>(before.vertices.size()), after.vertices.end()};
}

// The feet of points on the triangulation as it was.
std::vector<Vec3> flat(const SurfaceMesh& before, std::vector<Vec3> points) {
  const TriangleTree tree(before);
  for (Vec3& p : points) p = tree.closest(p).point;
  return points;
}

// The paper's condition, without the code under test: all points are searched, on a convex or tubular scan whose other
// side is farther away than the radius.
double content_share(const SurfaceMesh& mesh, double radius, Vec3 (*project)(const Vec3&)) {
  std::size_t content = 0;
  for (const Vec3& p : mesh.vertices) {
    const Vec3 centre = project == onto_torus ? Vec3(3 * Vec3(p[0], p[1], 0).normalized()) : Vec3(Vec3::Zero());
    const Vec3 normal = (p - centre).normalized();
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    std::vector<double> angles;
    for (const Vec3& q : mesh.vertices)
      if (const double d = (q - p).norm(); d > 0 && d <= radius)
        angles.push_back(std::atan2((q - p).dot(v), (q - p).dot(u)));
    std::sort(angles.begin(), angles.end());
    double widest = angles.empty() ? 2 * std::numbers::pi : angles.front() + 2 * std::numbers::pi - angles.back();
    for (std::size_t i = 0; i + 1 < angles.size(); ++i) widest = std::max(widest, angles[i + 1] - angles[i]);
    content += angles.size() > 6 || widest < std::numbers::pi / 2;
  }
  return static_cast<double>(content) / static_cast<double>(mesh.vertices.size());
}

TEST(Enrich, LiftedPointsAreCloserToTheTruthThanTheTriangulation) {
  for (const Scan& scan : scans())
    for (const Lifting lifting :
         {Lifting::triharmonic, Lifting::hermite, Lifting::moving_least_squares, Lifting::modified_quadratic_shepard}) {
      SurfaceMesh mesh = scan.mesh;
      const EnrichResult result = enrich(mesh, {.primitives = false, .lifting = lifting});
      ASSERT_GT(result.added, 100U);
      const auto points = new_points(scan.mesh, mesh);
      EXPECT_LT(rms_to_truth(scan, points), 0.3 * rms_to_truth(scan, flat(scan.mesh, points)))
          << scan.name << ", " << name_of(lifting);
    }
}

TEST(Enrich, ThePapersShepardAddsNoTruth) {
  for (const Scan& scan : scans()) {
    SurfaceMesh plain = scan.mesh, sound = scan.mesh;
    enrich(plain, {.primitives = false, .lifting = Lifting::shepard});
    enrich(sound, {.primitives = false});
    EXPECT_GT(rms_to_truth(scan, new_points(scan.mesh, plain)), 3 * rms_to_truth(scan, new_points(scan.mesh, sound)));
  }
}

TEST(Enrich, TheConditionHoldsAfterwards) {
  for (const Scan& scan : scans()) {
    SurfaceMesh mesh = scan.mesh;
    const EnrichResult result = enrich(mesh);
    EXPECT_LT(content_share(scan.mesh, result.sampling_radius, scan.project), 0.95) << "nothing to do";
    EXPECT_GE(content_share(mesh, result.sampling_radius, scan.project), 0.95) << scan.name;
    EXPECT_GE(static_cast<double>(result.content), 0.98 * static_cast<double>(result.domain_vertices)) << scan.name;
    EXPECT_EQ(result.domain_vertices, mesh.vertices.size());
  }
}

TEST(Enrich, PointsKeepTheirDistance) {
  for (const Scan& scan : scans()) {
    SurfaceMesh mesh = scan.mesh;
    const EnrichResult result = enrich(mesh);
    const auto points = new_points(scan.mesh, mesh);
    for (std::size_t i = 0; i < points.size(); ++i) {
      double nearest = HUGE_VAL;
      for (const Vec3& q : scan.mesh.vertices) nearest = std::min(nearest, (q - points[i]).norm());
      for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, (points[j] - points[i]).norm());
      ASSERT_GE(nearest, 0.35 * result.sampling_radius) << scan.name;
    }
  }
}

TEST(Enrich, TopologyAndOriginalVerticesStay) {
  for (const Scan& scan : scans())
    for (const Lifting lifting : all_liftings)
      for (const std::optional<StarObjective> place_by :
           {std::optional<StarObjective>(), std::optional(StarObjective::entropy_weighted)}) {
        SurfaceMesh mesh = scan.mesh;
        const EnrichResult result = enrich(mesh, {.primitives = false, .lifting = lifting, .place_by = place_by});
        const SurfaceValidity before = check_validity(scan.mesh), after = check_validity(mesh);
        EXPECT_TRUE(after.closed() && after.manifold());
        EXPECT_EQ(after.components, before.components);
        EXPECT_EQ(after.genus, before.genus);
        ASSERT_EQ(mesh.vertices.size(), scan.mesh.vertices.size() + result.added);
        EXPECT_TRUE(std::equal(scan.mesh.vertices.begin(), scan.mesh.vertices.end(), mesh.vertices.begin()));
        if (lifting == Lifting::hermite) {
          EXPECT_TRUE(find_self_intersections(mesh).empty()) << scan.name;
        }
      }
}

TEST(Enrich, AnEvenScanNeedsNothing) {
  SurfaceMesh mesh = analytic::sphere(1, 3);
  const std::size_t before = mesh.triangles.size();
  const EnrichResult result = enrich(mesh, {.sampling_radius = 1.5 * mean_edge_length(mesh)});
  EXPECT_EQ(result.added, 0U);
  EXPECT_EQ(result.stop, EnrichStop::all_content);
  EXPECT_EQ(mesh.triangles.size(), before);
}

TEST(Enrich, OnlyWhereTheSpacingExceedsTheWantedEdgeLength) {
  const Scan scan = scans()[1];
  // The dense half has edges of about 0.23, the thin one of 0.67.
  SurfaceMesh mesh = scan.mesh;
  enrich(mesh, {.sampling_radius = 0.45});
  const auto points = new_points(scan.mesh, mesh);
  ASSERT_GT(points.size(), 50U);
  const auto dense = std::count_if(points.begin(), points.end(), [](const Vec3& p) { return p[0] < -0.3; });
  EXPECT_LT(static_cast<double>(dense), 0.02 * static_cast<double>(points.size()));

  SurfaceMesh coarse = scan.mesh;
  EXPECT_EQ(enrich(coarse, {.sampling_radius = 2}).added, 0U) << "points enough for large triangles";
}

TEST(Enrich, StaysInsideTheDomain) {
  const Scan scan = scans()[0];
  SurfaceMesh mesh = scan.mesh;
  const auto outside = [](const Vec3& p) { return (p - Vec3(2, 0, 0)).norm() - 0.8; };
  EnrichOptions options{.sampling_radius = 0.2};
  options.domain.emplace();
  for (const Vec3& p : mesh.vertices) options.domain->push_back(outside(p) < 0);
  ASSERT_GT(enrich(mesh, options).added, 20U);
  for (const Vec3& p : new_points(scan.mesh, mesh))
    EXPECT_LT(outside(p), 0.05) << "the base lies inside, the height is less than this";
}

TEST(Enrich, BordersKeepTheirEdges) {
  const Scan scan = scans()[1];
  SurfaceMesh open{scan.mesh.vertices, {}};
  for (const Triangle& t : scan.mesh.triangles)
    if ((open.vertices[t[0]] + open.vertices[t[1]] + open.vertices[t[2]])[2] > 0) open.triangles.push_back(t);
  open = HalfedgeMesh(open).to_surface();  // drops the unused vertices
  SurfaceMesh mesh = open;
  ASSERT_GT(enrich(mesh).added, 50U);
  const SurfaceValidity before = check_validity(open), after = check_validity(mesh);
  EXPECT_TRUE(after.manifold());
  EXPECT_EQ(after.boundary_edges, before.boundary_edges);
  EXPECT_EQ(after.components, before.components);
}

TEST(Enrich, ThinWallsDoNotSeeTheirOtherSide) {
  // A plate 0.02 thick, points 0.5 apart: the other side is nearer than any neighbour.
  SurfaceMesh plate = analytic::box(Vec3(4, 4, 0.02), 0.5);
  SurfaceMesh mesh = plate;
  enrich(mesh, {.sampling_radius = 0.3});
  for (const Vec3& p : new_points(plate, mesh))
    EXPECT_TRUE(std::abs(p[2]) < 0.005 || std::abs(p[2] - 0.02) < 0.005 || std::min({p[0], p[1]}) < 0.3 ||
                std::max({p[0], p[1]}) > 3.7)
        << p.transpose();
  EXPECT_TRUE(check_validity(mesh).closed());
  EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(plate), 1e-6 * enclosed_volume(plate));
}

TEST(Enrich, ABoxStaysABox) {
  // The normals of all sides meet at its corners; a height from their mean would blow it up.
  for (const double edge : {4.0, 1.0}) {
    const SurfaceMesh box = analytic::box(Vec3(4, 4, 4), edge);
    SurfaceMesh mesh = box;
    ASSERT_GT(enrich(mesh, {.sampling_radius = 0.4}).added, 300U);
    EXPECT_NEAR(enclosed_volume(mesh), 64, 1e-9);
    for (const Vec3& p : mesh.vertices) EXPECT_NEAR((p - Vec3(2, 2, 2)).cwiseAbs().maxCoeff(), 2, 1e-9);
  }
}

TEST(Enrich, ACrowdedCornerDoesNotFillTheWholeSurface) {
  SurfaceMesh mesh = analytic::sphere(1, 5);
  CollapseOptions options{.target_faces = 3000, .cost = CollapseCost::sized_length};
  for (const Vec3& p : mesh.vertices) options.sizing.push_back(p[0] > 0.8 ? 1 : 10);
  collapse(mesh, options);
  const std::size_t before = mesh.vertices.size();
  EXPECT_LT(enrich(mesh).added, 6 * before);
}

TEST(SideNormals, PartAtSharpEdgesOnly) {
  const SurfaceMesh box = analytic::box(Vec3(1, 1, 1), 0.5);
  const SideNormals sharp(HalfedgeMesh(box), CornerWeight::angle);
  for (std::uint32_t v = 0; v < box.vertices.size(); ++v) {
    const Vec3 out = box.vertices[v] - Vec3(0.5, 0.5, 0.5);
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(out[axis]) > 0.4) {
        const Vec3 side = std::copysign(1.0, out[axis]) * Vec3::Unit(axis);
        EXPECT_NEAR((sharp.facing(v, side) - side).norm(), 0, 1e-12);
      }
  }
  // An octahedron bends by 71 degrees at all edges alike.
  SurfaceMesh coarse{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
                     {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}}};
  const SideNormals round(HalfedgeMesh(coarse), CornerWeight::angle);
  for (std::uint32_t v = 0; v < coarse.vertices.size(); ++v)
    EXPECT_NEAR((round.facing(v, Vec3::UnitX()) - coarse.vertices[v]).norm(), 0, 1e-9);
}

TEST(Enrich, ReportsTooManyVerticesAndRefusesWrongOptions) {
  SurfaceMesh mesh = analytic::sphere(1, 2);
  const EnrichResult result = enrich(mesh, {.sampling_radius = 0.05, .most_new_vertices = 100});
  EXPECT_EQ(result.added, 100U);
  EXPECT_EQ(result.stop, EnrichStop::too_many_vertices);
  EXPECT_THROW(enrich(mesh, {.sampling_radius = 0.0}), WrongUsage);
  EXPECT_THROW(enrich(mesh, {.most_neighbours = 0}), WrongUsage);
  EXPECT_THROW(enrich(mesh, {.empty_sector_deg = 10}), WrongUsage);
}

TEST(Enrich, CancellingLeavesTheMesh) {
  SurfaceMesh mesh = scans()[0].mesh;
  const std::size_t before = mesh.vertices.size();
  EXPECT_THROW(enrich(mesh, {}, Progress([](std::string_view, double) { return false; })), Cancelled);
  EXPECT_EQ(mesh.vertices.size(), before);
}

TEST(WalkStraight, GoesTheWholeWayOnAPlaneAndAroundASphere) {
  const HalfedgeMesh plate(analytic::box(Vec3(4, 4, 1), 0.5));
  std::uint32_t v = 0;
  while ((plate.points[v] - Vec3(2, 2, 1)).norm() > 1e-9) ++v;
  for (double angle = 0.1; angle < 6; angle += 0.7) {
    const Vec3 direction(std::cos(angle), std::sin(angle), 0);
    const auto end = walk_straight(plate, v, Vec3::UnitZ(), direction, 1.7);
    ASSERT_TRUE(end);
    EXPECT_NEAR((position(plate, *end) - (Vec3(2, 2, 1) + 1.7 * direction)).norm(), 0, 1e-9);
  }
  const HalfedgeMesh globe(analytic::sphere(1, 5));
  const Vec3 pole = globe.points[0].normalized();
  const auto end = walk_straight(globe, 0, pole, pole.unitOrthogonal(), std::numbers::pi / 2);
  ASSERT_TRUE(end);
  EXPECT_NEAR(position(globe, *end).dot(pole), 0, 0.02) << "a quarter of the way around is the equator";
}

TEST(WalkStraight, StopsAtABorder) {
  SurfaceMesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  const HalfedgeMesh mesh(square);
  const Vec3 diagonal = Vec3(1, 0.5, 0).normalized();
  EXPECT_TRUE(walk_straight(mesh, 0, Vec3::UnitZ(), diagonal, 1.0));
  EXPECT_FALSE(walk_straight(mesh, 0, Vec3::UnitZ(), diagonal, 1.5));
  EXPECT_FALSE(walk_straight(mesh, 0, Vec3::UnitZ(), -diagonal, 0.1));
}

TEST(DelaunayFlips, MendAFlatPatchAndLeaveCreases) {
  // A long quadrilateral with its long diagonal, and a vertex on the left.
  SurfaceMesh kite{{{0, 0, 0}, {2, -0.3, 0}, {4, 0, 0}, {2, 0.3, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  HalfedgeMesh mesh(kite);
  EXPECT_EQ(restore_delaunay(mesh, 1), 1U);
  EXPECT_TRUE(mesh.are_neighbours(1, 3));
  kite.vertices[3] = Vec3(2, 0.1, 0.5);
  HalfedgeMesh folded(kite);
  EXPECT_EQ(restore_delaunay(folded, 1), 0U);
}

}  // namespace
}  // namespace scan2fea
