#include "preproc/surface/collapse/collapse.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"
#include "preproc/surface/kernel/indexed_heap.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/triangle_tree.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace scan2fea {
namespace {

constexpr CollapseCost all_costs[] = {CollapseCost::bending_energy, CollapseCost::quadric_error,
                                      CollapseCost::edge_length, CollapseCost::sized_length};
constexpr CollapseLifting all_liftings[] = {CollapseLifting::keep_volume, CollapseLifting::closest_point,
                                            CollapseLifting::shepard};
const std::optional<StarObjective> all_placements[] = {std::nullopt,
                                                       StarObjective::shannon,
                                                       StarObjective::a_entropy,
                                                       StarObjective::regularised_a_entropy,
                                                       StarObjective::entropy_weighted,
                                                       StarObjective::mean_edge_ratio};

struct Shape {
  const char* name;
  SurfaceMesh mesh;
  std::size_t components;
  int genus;
};

std::vector<Shape> shapes() {
  return {
      {"torus", analytic::torus(3, 1, 60, 24), 1, 1},
      {"nested spheres", analytic::join(analytic::sphere(3, 3), analytic::reversed(analytic::sphere(1.5, 3))), 2, 0},
      {"slab of genus 5", analytic::slab_with_holes(5, 0.2), 1, 5}};
}

double farthest(const SurfaceMesh& from, const SurfaceMesh& to) {
  const TriangleTree tree(to);
  double worst = 0;
  for (const Vec3& p : from.vertices) worst = std::max(worst, tree.closest(p).squared_distance);
  return std::sqrt(worst);
}

CollapseOptions to_faces(const SurfaceMesh& mesh, std::size_t faces) {
  CollapseOptions options{.target_faces = faces};
  options.sizing.assign(mesh.vertices.size(), 1.0);
  return options;
}

void expect_same_topology(const SurfaceMesh& mesh, const Shape& shape, const std::string& how) {
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_TRUE(validity.closed() && validity.manifold()) << shape.name << ", " << how;
  EXPECT_EQ(validity.unused_vertices, 0U);
  EXPECT_EQ(validity.components, shape.components) << shape.name << ", " << how;
  EXPECT_EQ(validity.genus, shape.genus) << shape.name << ", " << how;
  EXPECT_GT(enclosed_volume(mesh), 0) << shape.name << ", " << how;
}

TEST(Collapse, TopologyNeverChangesAndTheCountIsExact) {
  for (const Shape& shape : shapes()) {
    const std::size_t target = shape.mesh.triangles.size() / 10 * 2;
    for (const CollapseCost cost : all_costs)
      for (const CollapseLifting lifting : all_liftings)
        for (const auto& objective : {all_placements[0], all_placements[4]}) {
          SurfaceMesh mesh = shape.mesh;
          CollapseOptions options = to_faces(mesh, target);
          options.cost = cost;
          options.lifting = lifting;
          options.objective = objective;
          const CollapseResult result = collapse(mesh, options);
          EXPECT_TRUE(result.reached_target);
          EXPECT_EQ(mesh.triangles.size(), target);
          EXPECT_EQ(result.faces_after, target);
          EXPECT_EQ(result.faces_before - 2 * result.collapses, target);
          expect_same_topology(mesh, shape, std::string(name_of(cost)));
        }
  }
}

TEST(Collapse, EveryObjectiveLeavesAValidSurface) {
  for (const Shape& shape : shapes())
    for (const auto& objective : all_placements) {
      SurfaceMesh mesh = shape.mesh;
      CollapseOptions options = to_faces(mesh, shape.mesh.triangles.size() / 6);
      options.objective = objective;
      EXPECT_TRUE(collapse(mesh, options).reached_target);
      expect_same_topology(mesh, shape, objective ? std::string(name_of(*objective)) : "midpoint");
    }
}

TEST(Collapse, KeepVolumeKeepsItToRounding) {
  for (const Shape& shape : shapes())
    for (const auto& objective : all_placements) {
      SurfaceMesh mesh = shape.mesh;
      for (Vec3& p : mesh.vertices) p += Vec3(100, -50, 20);  // far from the origin
      const double before = enclosed_volume(mesh);
      CollapseOptions options = to_faces(mesh, mesh.triangles.size() / 10);
      options.objective = objective;
      collapse(mesh, options);
      EXPECT_NEAR(enclosed_volume(mesh), before, 1e-10 * before) << shape.name;
    }
}

TEST(Collapse, ClosestPointPutsEveryVertexOnTheScan) {
  const SurfaceMesh torus = analytic::torus(3, 1, 60, 24);
  SurfaceMesh mesh = torus;
  CollapseOptions options = to_faces(mesh, 600);
  options.lifting = CollapseLifting::closest_point;
  collapse(mesh, options);
  EXPECT_LT(farthest(mesh, torus), 1e-12);
}

TEST(Collapse, StaysNearASmoothSurface) {
  // 800 triangles on a torus: edges of about 0.5, sagitta of 0.25^2 / 2 on the tube of radius 1.
  const SurfaceMesh torus = analytic::torus(3, 1, 120, 48);
  for (const CollapseCost cost : all_costs) {
    SurfaceMesh mesh = torus;
    CollapseOptions options = to_faces(mesh, 800);
    options.cost = cost;
    collapse(mesh, options);
    EXPECT_LT(farthest(torus, mesh), 0.1) << name_of(cost);
    EXPECT_LT(farthest(mesh, torus), 0.1) << name_of(cost);
    EXPECT_TRUE(find_self_intersections(mesh).empty()) << name_of(cost);
  }
}

TEST(Collapse, EntropyWeightedPlacementMakesBetterTrianglesThanMidpoints) {
  const SurfaceMesh torus = analytic::noisy(analytic::torus(3, 1, 120, 48), 0.005, 3);
  const auto with = [&](std::optional<StarObjective> objective) {
    SurfaceMesh mesh = torus;
    CollapseOptions options = to_faces(mesh, 1200);
    options.objective = objective;
    collapse(mesh, options);
    return measure_triangles(mesh).edge_ratio.mean;
  };
  const double phi = with(StarObjective::entropy_weighted);
  EXPECT_LT(phi, with(std::nullopt));
  EXPECT_LT(phi, with(StarObjective::shannon)) << "eq. 2 alone does not make triangles equilateral";
  EXPECT_LT(phi, with(StarObjective::a_entropy)) << "nor does eq. 3";
}

TEST(Collapse, SizedLengthFollowsTheSizingField) {
  SurfaceMesh mesh = analytic::sphere(1, 5);
  CollapseOptions options = to_faces(mesh, 1500);
  options.cost = CollapseCost::sized_length;
  const auto wanted = [](const Vec3& p) { return p[2] > 0 ? 1.0 : 3.0; };
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) options.sizing[v] = wanted(mesh.vertices[v]);
  collapse(mesh, options);
  double fine = 0, coarse = 0;
  for (const Triangle& t : mesh.triangles) {
    const double z = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]])[2] / 3;
    if (z > 0.3) ++fine;
    if (z < -0.3) ++coarse;
  }
  // Areas, and so counts, go with the square of the size.
  EXPECT_NEAR(fine / coarse, 9, 3);
}

TEST(Collapse, BendingEnergyHoldsSharpEdgesBetterThanLength) {
  const SurfaceMesh box = analytic::box(Vec3(4, 4, 1), 0.1);
  const auto deviation = [&](CollapseCost cost) {
    SurfaceMesh mesh = box;
    CollapseOptions options = to_faces(mesh, 400);
    options.cost = cost;
    collapse(mesh, options);
    const TriangleTree tree(mesh);
    double sum = 0;
    for (const Vec3& p : box.vertices) sum += tree.closest(p).squared_distance;
    return sum;
  };
  EXPECT_LT(deviation(CollapseCost::bending_energy), 0.7 * deviation(CollapseCost::edge_length));
}

TEST(Collapse, BordersStayWhereTheyAre) {
  // The upper half of a torus: an annulus with two circular borders.
  const SurfaceMesh torus = analytic::torus(3, 1, 60, 24);
  SurfaceMesh open{torus.vertices, {}};
  for (const Triangle& t : torus.triangles)
    if ((torus.vertices[t[0]] + torus.vertices[t[1]] + torus.vertices[t[2]])[2] > 0) open.triangles.push_back(t);
  SurfaceMesh mesh = open;
  const CollapseResult result = collapse(mesh, to_faces(mesh, 301));
  EXPECT_TRUE(result.reached_target);
  EXPECT_LE(mesh.triangles.size(), 301U);
  EXPECT_GE(mesh.triangles.size(), 300U);
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_TRUE(validity.manifold());
  EXPECT_EQ(validity.components, 1U);
  const HalfedgeMesh halves(mesh);
  for (std::uint32_t v = 0; v < halves.vertex_slots(); ++v)
    if (halves.is_border_vertex(v)) {
      const Vec3& p = mesh.vertices[v];
      EXPECT_LT(std::min(std::abs(p.head<2>().norm() - 4), std::abs(p.head<2>().norm() - 2)), 0.1);
      EXPECT_NEAR(p[2], 0, 0.3);
    }
}

TEST(Collapse, StopsWhereTopologyForbidsMore) {
  const Shape shape{"torus", analytic::torus(3, 1, 12, 8), 1, 1};
  SurfaceMesh mesh = shape.mesh;
  const CollapseResult result = collapse(mesh, to_faces(mesh, 4));
  EXPECT_FALSE(result.reached_target);
  EXPECT_GE(result.faces_after, 14U) << "no torus has fewer triangles";
  expect_same_topology(mesh, shape, "as far as it goes");
}

TEST(Collapse, LeavesASurfaceThatIsSmallEnoughAlone) {
  const SurfaceMesh sphere = analytic::sphere(1, 1);
  SurfaceMesh mesh = sphere;
  const CollapseResult result = collapse(mesh, to_faces(mesh, 1000));
  EXPECT_EQ(result.collapses, 0U);
  EXPECT_EQ(mesh.triangles, sphere.triangles);
}

TEST(Collapse, RefusesOptionsOutOfRangeAndKeepsTheMeshOnFailure) {
  const SurfaceMesh sphere = analytic::sphere(1, 2);
  SurfaceMesh mesh = sphere;
  EXPECT_THROW(collapse(mesh, to_faces(mesh, 0)), WrongUsage);
  CollapseOptions sized{.target_faces = 100, .cost = CollapseCost::sized_length};
  EXPECT_THROW(collapse(mesh, sized), WrongUsage);
  CollapseOptions turn{.target_faces = 100, .largest_normal_turn_deg = 120};
  EXPECT_THROW(collapse(mesh, turn), WrongUsage);
  const Progress stop([](std::string_view, double fraction) { return fraction < 0.5; });
  EXPECT_THROW(collapse(mesh, to_faces(mesh, 40), stop), Cancelled);
  EXPECT_EQ(mesh.triangles, sphere.triangles);
  EXPECT_EQ(mesh.vertices, sphere.vertices);
}

TEST(CollapseCostName, RoundTrips) {
  for (const CollapseCost cost : all_costs) EXPECT_EQ(collapse_cost_named(name_of(cost)), cost);
  EXPECT_EQ(collapse_cost_named("volume"), std::nullopt);
}

TEST(IndexedHeap, ComesOutInOrderWhateverIsRemovedAndPutBack) {
  std::mt19937 random(1);
  IndexedHeap heap(200);
  std::vector<double> key(200);
  std::vector<bool> inside(200, false);
  for (int step = 0; step < 5000; ++step) {
    const auto m = static_cast<std::uint32_t>(random() % 200);
    EXPECT_EQ(heap.contains(m), inside[m]);
    if (inside[m]) {
      heap.remove(m);
    } else {
      key[m] = static_cast<double>(random() % 20);  // many ties
      heap.push(m, key[m]);
    }
    inside[m] = !inside[m];
  }
  std::pair<double, std::uint32_t> last{-1, 0};
  while (!heap.empty()) {
    const std::pair<double, std::uint32_t> now{heap.top_key(), heap.top()};
    EXPECT_LT(last, now);
    EXPECT_EQ(heap.pop(), now.second);
    last = now;
  }
}

}  // namespace
}  // namespace scan2fea
