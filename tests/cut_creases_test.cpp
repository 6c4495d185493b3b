#include "preproc/surface/enrichment/cut_creases.hpp"

#include "preproc/surface/enrichment/enrich.hpp"
#include "preproc/surface/primitives/meeting_point.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace scan2fea {
namespace {

// A box that was scanned with no point on its edges: vertices near an edge lie a little inside of the faces.
SurfaceMesh box_without_edges(const Vec3& size, double edge_length) {
  SurfaceMesh box = analytic::box(size, edge_length);
  for (Vec3& p : box.vertices) {
    int sides = 0;
    for (int i = 0; i < 3; ++i) sides += p[i] < 1e-9 || p[i] > size[i] - 1e-9;
    if (sides < 2) continue;
    // Onto one of the faces, beside the edge.
    bool kept = false;
    for (int i = 0; i < 3; ++i) {
      if (p[i] > 1e-9 && p[i] < size[i] - 1e-9) continue;
      if (kept) p[i] += (p[i] < 1e-9 ? 1 : -1) * 0.35 * edge_length;
      kept = true;
    }
  }
  return box;
}

double rms_off_box(const std::vector<Vec3>& points, const Vec3& size) {
  double sum = 0;
  for (const Vec3& p : points) {
    const double off = ((p - 0.5 * size).cwiseAbs() - 0.5 * size).maxCoeff();
    sum += off * off;
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(MeetingPoint, IsOnAllShapes) {
  const Shape floor{.kind = ShapeKind::plane, .origin = Vec3::Zero(), .axis = Vec3::UnitZ()};
  const Shape wall{.kind = ShapeKind::plane, .origin = Vec3(0, 1, 0), .axis = Vec3(0, 1, 1).normalized()};
  const Shape pipe{.kind = ShapeKind::cylinder, .origin = Vec3(2, 0, 5), .axis = Vec3::UnitZ(), .radius = 3};
  const std::array<const Shape*, 3> all{&floor, &wall, &pipe};
  for (std::size_t count = 1; count <= 3; ++count) {
    const auto shapes = std::span(all).first(count);
    const auto point = meeting_point(shapes, Vec3(4.4, 1.2, 0.3));
    ASSERT_TRUE(point);
    for (const Shape* shape : shapes) EXPECT_NEAR(shape->signed_distance(*point), 0, 1e-9);
    EXPECT_LT((*point - Vec3(4.4, 1.2, 0.3)).norm(), 1);
  }
}

TEST(MeetingPoint, IsNotToldByShapesThatAreTangentOrApart) {
  const Shape floor{.kind = ShapeKind::plane, .origin = Vec3::Zero(), .axis = Vec3::UnitZ()};
  const Shape above{.kind = ShapeKind::plane, .origin = Vec3(0, 0, 1), .axis = Vec3::UnitZ()};
  const Shape ball{.kind = ShapeKind::sphere, .origin = Vec3(0, 0, 3), .radius = 3};
  const std::array<const Shape*, 2> parallel{&floor, &above}, tangent{&floor, &ball};
  EXPECT_FALSE(meeting_point(parallel, Vec3(0, 0, 0.5)));
  EXPECT_FALSE(meeting_point(tangent, Vec3(0.1, 0, 0.01)));
}

TEST(CutCreases, GiveABoxItsEdgesBack) {
  const Vec3 size(20, 12, 8);
  const SurfaceMesh scan = box_without_edges(size, 1);
  const Primitives found = find_primitives(scan);
  ASSERT_EQ(found.list.size(), 6U);
  HalfedgeMesh mesh(scan);
  SurfaceLabels labels(mesh, found);
  ClearSurface clear(mesh, 1);
  const double volume_before = enclosed_volume(scan);
  const CreaseCutResult cut = cut_creases(mesh, labels, clear);
  EXPECT_EQ(scan.vertices.size() + cut.bases.size(), mesh.vertex_slots());
  const SurfaceMesh after = mesh.to_surface();
  EXPECT_LT(volume_before, 0.99 * size.prod());
  EXPECT_GT(enclosed_volume(after), 0.998 * size.prod());
  EXPECT_LE(enclosed_volume(after), size.prod() * (1 + 1e-9));
  const SurfaceValidity validity = check_validity(after);
  EXPECT_TRUE(validity.closed() && validity.manifold());
  EXPECT_TRUE(find_self_intersections(after).empty());
  double creases = 0;
  for (HalfedgeMesh::Index h = 0; h < 3 * mesh.face_slots(); ++h)
    if (mesh.is_face_alive(HalfedgeMesh::face(h)) && labels.is_crease(h))
      creases += 0.5 * (mesh.points[mesh.origin(h)] - mesh.points[mesh.target(h)]).norm();
  EXPECT_GT(creases, 0.85 * 4 * size.sum());
}

TEST(Enrich, PutsNewPointsOntoPrimitives) {
  const Vec3 size(20, 12, 8);
  const SurfaceMesh scan = box_without_edges(size, 1);
  SurfaceMesh mesh = scan;
  const EnrichResult result = enrich(mesh, {.sampling_radius = 0.8});
  EXPECT_EQ(result.primitives.size(), 6U);
  ASSERT_GT(result.added, 500U);
  EXPECT_EQ(mesh.vertices.size(), scan.vertices.size() + result.added);
  EXPECT_LT(rms_off_box(mesh.vertices, size), 0.02);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  double creases = 0;
  for (const FeatureEdge& edge : result.creases) creases += (mesh.vertices[edge[0]] - mesh.vertices[edge[1]]).norm();
  EXPECT_GT(creases, 0.85 * 4 * size.sum());
}

TEST(Enrich, LiterallyKeepsASoundMeshAllTheSame) {
  SurfaceMesh mesh = analytic::torus(3, 1, 40, 16);
  const EnrichResult result = enrich(mesh, EnrichOptions::literal());
  EXPECT_GT(result.added, 100U);
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_TRUE(validity.closed() && validity.manifold());
  EXPECT_TRUE(find_self_intersections(mesh).empty());
}

TEST(ClearSurface, RefusesWhatWouldRunThroughTheSurface) {
  // Two sheets, one over the other.
  SurfaceMesh sheets =
      analytic::join(analytic::sheet(4, 4, 1), analytic::moved(analytic::sheet(4, 4, 1), Vec3(0.3, 0.3, 0.5)));
  HalfedgeMesh mesh(sheets);
  ClearSurface clear(mesh, 1);
  std::uint32_t v = 0;
  while ((mesh.points[v] - Vec3(2, 2, 0)).norm() > 1e-9) ++v;
  EXPECT_FALSE(clear.move(v, Vec3(2, 2, 0.7)));
  EXPECT_EQ(mesh.points[v], Vec3(2, 2, 0));
  EXPECT_TRUE(clear.move(v, Vec3(2, 2, 0.3)));
  EXPECT_EQ(mesh.points[v], Vec3(2, 2, 0.3));
  EXPECT_FALSE(clear.move(v, Vec3(3, 2, 0.01))) << "onto a neighbour";
  EXPECT_TRUE(find_self_intersections(mesh.to_surface()).empty());
}

TEST(ClearSurface, KnowsOfFlips) {
  SurfaceMesh kite{{{0, 0, 0}, {2, -1, 0}, {4, 0, 0}, {2, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  // A needle through the other diagonal, above the kite where that is flat.
  kite.vertices[1][2] = kite.vertices[3][2] = 1;
  const auto first = static_cast<std::uint32_t>(kite.vertices.size());
  for (const Vec3& p : {Vec3(1.9, 0, 0.5), Vec3(2.1, 0, 0.5), Vec3(2, 0, 2)}) kite.vertices.push_back(p);
  kite.triangles.push_back({first, first + 1, first + 2});
  HalfedgeMesh mesh(kite);
  ClearSurface clear(mesh, 1);
  EXPECT_FALSE(clear.clear_to_flip(mesh.find_halfedge(0, 2)));
  for (const std::uint32_t v : {first + 2, first + 1, first})
    ASSERT_TRUE(clear.move(v, mesh.points[v] + Vec3(0, 0, 3)));
  EXPECT_TRUE(clear.clear_to_flip(mesh.find_halfedge(0, 2)));
}

}  // namespace
}  // namespace scan2fea
