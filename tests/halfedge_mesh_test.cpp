#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include "preproc/mesh/error.hpp"
#include "tests/analytic_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// Everything that the class promises about its own arrays.
void expect_consistent(const HalfedgeMesh& mesh) {
  std::size_t live = 0;
  std::vector<std::size_t> halfedges_at(mesh.vertex_slots(), 0);
  std::set<std::pair<Index, Index>> directed;
  for (Index f = 0; f < mesh.face_slots(); ++f) {
    if (!mesh.is_face_alive(f)) continue;
    ++live;
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      ++halfedges_at[mesh.origin(h)];
      ASSERT_NE(mesh.origin(h), mesh.target(h));
      ASSERT_TRUE(directed.insert({mesh.origin(h), mesh.target(h)}).second) << "doubled half-edge";
      if (mesh.is_border(h)) continue;
      const Index o = mesh.opposite(h);
      ASSERT_EQ(mesh.opposite(o), h);
      ASSERT_EQ(mesh.origin(o), mesh.target(h));
      ASSERT_EQ(mesh.target(o), mesh.origin(h));
    }
  }
  ASSERT_EQ(live, mesh.face_count());
  for (Index v = 0; v < mesh.vertex_slots(); ++v) {
    std::size_t met = 0;
    mesh.for_each_outgoing(v, [&](Index h) {
      ASSERT_EQ(mesh.origin(h), v);
      ++met;
    });
    ASSERT_EQ(met, halfedges_at[v]) << "vertex " << v;
  }
}

int euler_characteristic(const HalfedgeMesh& mesh) {
  int vertices = 0, halves = 0, borders = 0;
  for (Index v = 0; v < mesh.vertex_slots(); ++v) vertices += mesh.is_alive(v);
  for (Index h = 0; h < 3 * mesh.face_slots(); ++h) {
    if (!mesh.is_face_alive(HalfedgeMesh::face(h))) continue;
    ++halves;
    borders += mesh.is_border(h);
  }
  return vertices - (halves + borders) / 2 + static_cast<int>(mesh.face_count());
}

SurfaceMesh square_grid(unsigned n) {
  SurfaceMesh mesh;
  for (unsigned y = 0; y <= n; ++y)
    for (unsigned x = 0; x <= n; ++x) mesh.vertices.emplace_back(x, y, 0);
  for (unsigned y = 0; y < n; ++y)
    for (unsigned x = 0; x < n; ++x) {
      const unsigned a = y * (n + 1) + x, b = a + 1, c = b + n + 1, d = a + n + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

TEST(HalfedgeMesh, KeepsTheSurface) {
  const SurfaceMesh torus = analytic::torus(2, 0.7, 12, 8);
  const HalfedgeMesh mesh(torus);
  expect_consistent(mesh);
  const SurfaceMesh back = mesh.to_surface();
  EXPECT_EQ(back.triangles, torus.triangles);
  EXPECT_EQ(back.vertices.size(), torus.vertices.size());
}

TEST(HalfedgeMesh, VisitsTheWholeFanOfABorderVertex) {
  const HalfedgeMesh mesh(square_grid(3));
  expect_consistent(mesh);
  EXPECT_TRUE(mesh.is_border_vertex(1));
  EXPECT_FALSE(mesh.is_border_vertex(5));
  EXPECT_EQ(mesh.valence(1), 4U);
  EXPECT_EQ(mesh.valence(5), 6U);
}

TEST(HalfedgeMesh, RefusesWhatIsNotManifold) {
  SurfaceMesh fin = analytic::sphere(1, 1);
  fin.vertices.emplace_back(3, 3, 3);
  fin.triangles.push_back({fin.triangles[0][0], fin.triangles[0][1], static_cast<Index>(fin.vertices.size() - 1)});
  EXPECT_THROW(HalfedgeMesh{fin}, NotMeshable);

  SurfaceMesh turned = analytic::sphere(1, 1);
  std::swap(turned.triangles[7][0], turned.triangles[7][1]);
  EXPECT_THROW(HalfedgeMesh{turned}, NotMeshable);

  SurfaceMesh touching = analytic::join(analytic::sphere(1, 0), analytic::sphere(1, 0));
  for (auto& t : touching.triangles)
    for (auto& v : t)
      if (v == 12) v = 0;
  EXPECT_THROW(HalfedgeMesh{touching}, NotMeshable);

  SurfaceMesh repeated = analytic::sphere(1, 0);
  repeated.triangles[3][1] = repeated.triangles[3][0];
  EXPECT_THROW(HalfedgeMesh{repeated}, NotMeshable);
}

TEST(HalfedgeMesh, RandomChangesKeepTopology) {
  for (const SurfaceMesh& shape : {analytic::torus(2, 0.7, 12, 8), analytic::slab_with_holes(2, 0.5), square_grid(6)}) {
    HalfedgeMesh mesh(shape);
    const int euler = euler_characteristic(mesh);
    std::mt19937 random(7);
    int changes = 0;
    for (int step = 0; step < 3000; ++step) {
      const Index h = static_cast<Index>(random() % (3 * mesh.face_slots()));
      if (!mesh.is_face_alive(HalfedgeMesh::face(h))) continue;
      const Vec3 middle = 0.5 * (mesh.points[mesh.origin(h)] + mesh.points[mesh.target(h)]);
      const unsigned kind = random() % 8;
      if (kind < 4 && mesh.can_collapse(h)) {
        mesh.collapse(h);
      } else if (kind < 6 && mesh.can_flip(h)) {
        mesh.flip(h);
      } else if (kind == 6 && mesh.face_count() < 400) {
        mesh.split_edge(h, middle);
      } else if (kind == 7 && mesh.face_count() < 400) {
        mesh.split_face(HalfedgeMesh::face(h), middle);
      } else {
        continue;
      }
      ++changes;
      ASSERT_NO_FATAL_FAILURE(expect_consistent(mesh)) << "step " << step << ", kind " << kind;
    }
    EXPECT_GT(changes, 500);
    EXPECT_EQ(euler_characteristic(mesh), euler);
    EXPECT_NO_THROW(HalfedgeMesh{mesh.to_surface()});
  }
}

TEST(HalfedgeMesh, ATetrahedronCannotBeCollapsed) {
  SurfaceMesh shape;
  shape.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  shape.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  const HalfedgeMesh mesh(shape);
  for (Index h = 0; h < 12; ++h) {
    EXPECT_FALSE(mesh.can_collapse(h));
    EXPECT_FALSE(mesh.can_flip(h));
  }
}

TEST(HalfedgeMesh, SplitsKeepTheArea) {
  const SurfaceMesh shape = analytic::torus(2, 0.7, 12, 8);
  HalfedgeMesh mesh(shape);
  const Index on_edge = mesh.split_edge(5, 0.5 * (mesh.points[mesh.origin(5)] + mesh.points[mesh.target(5)]));
  EXPECT_EQ(mesh.target(5), on_edge);
  EXPECT_EQ(mesh.valence(on_edge), 4U);
  const Triangle t = mesh.triangle(0);
  const Index inside = mesh.split_face(0, (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3);
  EXPECT_EQ(mesh.valence(inside), 3U);
  EXPECT_NEAR(surface_area(mesh.to_surface()), surface_area(shape), 1e-12 * surface_area(shape));
}

}  // namespace
}  // namespace scan2fea
