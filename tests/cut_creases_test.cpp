#include "preproc/surface/enrichment/cut_creases.hpp"

#include "preproc/surface/enrichment/enrich.hpp"
#include "preproc/surface/enrichment/unfold.hpp"
#include "preproc/surface/primitives/meeting_point.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
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

double length_of_creases(const HalfedgeMesh& mesh, const SurfaceLabels& labels) {
  double length = 0;
  for (HalfedgeMesh::Index h = 0; h < 3 * mesh.face_slots(); ++h)
    if (mesh.is_face_alive(HalfedgeMesh::face(h)) && labels.is_crease(h))
      length += 0.5 * (mesh.points[mesh.origin(h)] - mesh.points[mesh.target(h)]).norm();
  return length;
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
  EXPECT_GT(length_of_creases(mesh, labels), 0.85 * 4 * size.sum());
}

// A washer about the z axis, radii 10 and 16, 4 thick, a column of vertices every 10 degrees; of the hole's wall, with
// its rims, only the columns up to 270 degrees were seen. The surface cuts through the hole there.
SurfaceMesh washer_with_a_gap() {
  constexpr std::uint32_t columns = 36, seen = 28, rows = 5;
  std::vector<Vec3> section;  // without the wall of the hole; from its lower rim to the upper one
  for (int i = 1; i < 6; ++i) section.emplace_back(10 + i, 0, 0);
  for (int i = 0; i < 5; ++i) section.emplace_back(16, 0, i);
  for (int i = 5; i > 0; --i) section.emplace_back(10 + i, 0, 4);
  SurfaceMesh mesh;
  const auto put = [&](std::uint32_t column, const Vec3& p) {
    mesh.vertices.emplace_back(Eigen::AngleAxisd(column * 10 / 57.29577951308232, Vec3::UnitZ()) * p);
  };
  for (std::uint32_t i = 0; i < columns; ++i)
    for (const Vec3& p : section) put(i, p);
  const auto along = static_cast<std::uint32_t>(section.size()), wall = columns * along;
  for (std::uint32_t i = 0; i < seen; ++i)
    for (std::uint32_t j = 0; j < rows; ++j) put(i, Vec3(10, 0, j));
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i < columns; ++i)
    for (std::uint32_t j = 0; j + 1 < along; ++j) {
      const std::uint32_t here = i * along + j, next = (i + 1) % columns * along + j;
      quad(here, here + 1, next + 1, next);
    }
  for (std::uint32_t i = 0; i < seen; ++i)
    for (std::uint32_t j = 0; j + 1 < rows; ++j) {
      const std::uint32_t here = wall + i * rows + j, next = wall + (i + 1) % seen * rows + j;
      quad(next, next + 1, here + 1, here);
    }
  // Between the rims and the rings beside them; over the gap a fan from each of its ends.
  for (const bool upper : {false, true}) {
    const auto rim = [&](std::uint32_t i) { return wall + i % seen * rows + (upper ? rows - 1 : 0); };
    const auto ring = [&](std::uint32_t i) { return i % columns * along + (upper ? along - 1 : 0); };
    const auto face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      upper ? mesh.triangles.push_back({b, a, c}) : mesh.triangles.push_back({a, b, c});
    };
    for (std::uint32_t i = 0; i + 1 < seen; ++i) {
      face(rim(i), ring(i), ring(i + 1));
      face(rim(i), ring(i + 1), rim(i + 1));
    }
    constexpr std::uint32_t middle = (seen - 1 + columns) / 2;
    for (std::uint32_t i = seen - 1; i < columns; ++i) face(rim(i < middle ? seen - 1 : 0), ring(i), ring(i + 1));
    face(rim(seen - 1), ring(middle), rim(0));
  }
  return enclosed_volume(mesh) > 0 ? mesh : analytic::reversed(mesh);
}

double nearest_to_axis(const SurfaceMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 middle = 0.5 * (mesh.vertices[t[k]] + mesh.vertices[t[(k + 1) % 3]]);
      least = std::min(least, middle.head<2>().norm());
    }
  return least;
}

TEST(CutCreases, LeaveNothingInsideAHole) {
  const SurfaceMesh scan = washer_with_a_gap();
  ASSERT_TRUE(check_validity(scan).closed() && check_validity(scan).manifold());
  ASSERT_LT(nearest_to_axis(scan), 7.2);
  const Primitives found = find_primitives(scan);
  ASSERT_GE(found.list.size(), 4U);
  HalfedgeMesh mesh(scan);
  SurfaceLabels labels(mesh, found);
  ClearSurface clear(mesh, 1.5);
  cut_creases(mesh, labels, clear);
  const SurfaceMesh after = mesh.to_surface();
  EXPECT_GT(nearest_to_axis(after), 9);
  EXPECT_TRUE(check_validity(after).closed());
  EXPECT_TRUE(find_self_intersections(after).empty());
}

TEST(CutCreases, TakePointsOnEitherSideOfACrease) {
  // Points on the edges of a box, which noise puts on one side or the other.
  const Vec3 size(20, 12, 8);
  const SurfaceMesh scan = analytic::noisy(analytic::box(size, 1), 0.02, 3);
  const Primitives found = find_primitives(scan);
  ASSERT_EQ(found.list.size(), 6U);
  HalfedgeMesh mesh(scan);
  SurfaceLabels labels(mesh, found);
  ClearSurface clear(mesh, 1);
  cut_creases(mesh, labels, clear);
  EXPECT_GT(length_of_creases(mesh, labels), 0.98 * 4 * size.sum());
  EXPECT_LT(length_of_creases(mesh, labels), 1.02 * 4 * size.sum());
}

TEST(Unfold, OpensAFoldByTurningItsEdge) {
  // A flat hexagon of which one corner's two faces lie on the others: the diagonal between them is the wrong one.
  SurfaceMesh sheet{{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}, {1.6, 1, 0.05}},
                    {{0, 1, 5}, {1, 2, 3}, {1, 3, 5}, {3, 4, 5}, {4, 0, 5}}};
  sheet.vertices[5] = {2.4, 1, 0.05};  // beyond the diagonal from 1 to 3
  HalfedgeMesh mesh(sheet);
  Primitives none;
  none.labels.assign(sheet.vertices.size(), no_primitive);
  const SurfaceLabels labels(mesh, none);
  ClearSurface clear(mesh, 1);
  EXPECT_GT(unfold(mesh, labels, clear), 0U);
  const SurfaceMesh after = mesh.to_surface();
  for (const Triangle& t : after.triangles) EXPECT_GT(area_vector(after, t).z(), 0);
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
