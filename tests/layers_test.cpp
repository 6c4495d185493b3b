// Layers of elements behind parts of a surface.
#include "preproc/bodies_pipeline.hpp"
#include "preproc/mesh/numbers.hpp"
#include "preproc/pipeline.hpp"
#include "preproc/surface/faces/selection.hpp"
#include "quality/self_intersections.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/error_from.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace scan2fea {
namespace {

using ::testing::HasSubstr;

constexpr LayerHeights five{.count = 5, .first = 0.15, .growth = 1.3};

SurfaceMesh pipe() {
  return analytic::pipe(8, 12, 30, 96);
}

SurfaceMesh plate() {
  return analytic::box({40, 30, 6}, 1);
}

PipelineOptions options_with(const std::string& set, const LayerHeights& heights, std::size_t faces = 1200) {
  PipelineOptions options;
  options.simplify->size = FaceCount{faces};
  if (!set.empty()) options.sets = {parse_selection(set, "")};
  options.layers = {{.set = set.substr(0, set.find('=')), .heights = heights}};
  return options;
}

const StageRecord& stage_of(const PipelineResult& result) {
  return *std::ranges::find(result.stages, "layers", &StageRecord::name);
}

double figure(const PipelineResult& result, const std::string& name) {
  const auto& changes = stage_of(result).changes;
  const auto found = std::ranges::find(changes, name, [](const auto& change) { return change.first; });
  return found == changes.end() ? std::nan("") : found->second;
}

// What any solver needs, whatever the layers are.
void expect_sound(const PipelineResult& result, const SurfaceMesh& scan) {
  const TetMesh& mesh = *result.volume_mesh;
  EXPECT_EQ(measure_tetrahedra(mesh).inverted, 0U);
  EXPECT_TRUE(find_self_intersections(result.surface).empty());
  EXPECT_NEAR(total_volume(mesh), enclosed_volume(scan), 1e-8 * enclosed_volume(scan));
  ASSERT_EQ(mesh.boundary.size(), result.surface.triangles.size());
  EXPECT_EQ(find_boundary(mesh.tetrahedra).size(), mesh.boundary.size());
  for (std::size_t f = 0; f < mesh.boundary.size(); ++f)
    ASSERT_EQ(boundary_triangle(mesh, mesh.boundary[f]), result.surface.triangles[f]) << f;
  for (std::size_t v = 0; v < result.surface.vertices.size(); ++v)
    ASSERT_EQ(mesh.nodes[v], result.surface.vertices[v]) << v;
  const VertexStars stars(result.surface);
  for (const FeatureEdge& edge : result.line_edges) {
    const auto corners = stars.corners(edge[0]);
    EXPECT_TRUE(std::ranges::any_of(corners, [&](std::uint32_t corner) {
      return std::ranges::count(result.surface.triangles[corner / 3], edge[1]) > 0;
    })) << "a line that is no edge";
  }
}

// How many nodes of the elements in layers are so far behind the wall, by the depths that `depth_of` tells.
template <class Depth>
std::map<int, std::size_t> nodes_by_layer(const PipelineResult& result, const LayerHeights& layers, double tolerance,
                                          const Depth& depth_of) {
  const TetMesh& mesh = *result.volume_mesh;
  const auto in_layers = static_cast<std::size_t>(figure(result, "layer_tetrahedra"));
  std::vector<bool> is_of_layers(mesh.nodes.size(), false);
  for (std::size_t t = 0; t < in_layers; ++t)
    for (const std::uint32_t v : mesh.tetrahedra[t]) is_of_layers[v] = true;
  std::map<int, std::size_t> count;
  for (std::size_t v = 0; v < mesh.nodes.size(); ++v) {
    if (!is_of_layers[v]) continue;
    int layer = -1;
    for (int k = 0; k <= layers.count; ++k)
      if (std::abs(depth_of(mesh.nodes[v]) - layers.share(k) * layers.total()) < tolerance) layer = k;
    ++count[layer];
  }
  return count;
}

TEST(Layers, OfAPlateAreAsManyAndAsHighAsAskedFor) {
  const PipelineResult result = run_pipeline(plate(), options_with("top=plane(z>5.9)", five));
  expect_sound(result, plate());
  const NamedSet& top = result.face_sets.front();
  EXPECT_EQ(figure(result, "layer_tetrahedra"), 3 * 5 * static_cast<double>(top.members.size()));
  EXPECT_EQ(figure(result, "lower_vertices"), 0);
  EXPECT_EQ(figure(result, "tapered_vertices"), 0);
  const std::size_t of_top = vertices_of_faces(result.surface, top.members).size();
  const auto count = nodes_by_layer(result, five, 1e-7, [](const Vec3& p) { return 6 - p.z(); });
  EXPECT_EQ(count,
            (std::map<int, std::size_t>{{0, of_top}, {1, of_top}, {2, of_top}, {3, of_top}, {4, of_top}, {5, of_top}}));
  EXPECT_NEAR(result.sets.front().area, 1200, 1e-9);
  // What has made room is still in the plate's sides.
  for (const Vec3& p : result.surface.vertices)
    EXPECT_LT(p.cwiseMin(Vec3(40, 30, 6) - p).cwiseAbs().minCoeff(), 1e-12) << p.transpose();
}

// Elements behind the layers are as good as without them.
TEST(Layers, LeaveTheRestToGoodElements) {
  const PipelineResult result = run_pipeline(plate(), options_with("top=plane(z>5.9)", five));
  TetMesh rest = *result.volume_mesh;
  rest.tetrahedra.erase(rest.tetrahedra.begin(),
                        rest.tetrahedra.begin() + static_cast<std::ptrdiff_t>(figure(result, "layer_tetrahedra")));
  EXPECT_GT(measure_tetrahedra(rest).min_dihedral_deg, 25);
  EXPECT_TRUE(result.weak_places.empty()) << result.weak_places.front().describe();
}

TEST(Layers, OfABoreAreRoundAndEndInTheEndFaces) {
  const SurfaceMesh scan = pipe();
  const PipelineResult result = run_pipeline(scan, options_with("bore=cylinder(r=8+-0.3)", five, 3000));
  expect_sound(result, scan);
  const NamedSet& bore = result.face_sets.front();
  EXPECT_EQ(figure(result, "layer_tetrahedra"), 3 * 5 * static_cast<double>(bore.members.size()));
  // From each vertex of the bore straight outwards, or along the end face. Nodes of a surface lie off the bore by some
  // hundredths, those of layers by as much, so that heights are held against the nearest vertex of the bore.
  const std::vector<std::uint32_t> wall = vertices_of_faces(result.surface, bore.members);
  const auto depth = [&](const Vec3& p) {
    double nearest = infinity;
    for (const std::uint32_t v : wall) nearest = std::min(nearest, (result.surface.vertices[v] - p).norm());
    return nearest;
  };
  const auto count = nodes_by_layer(result, five, 0.01 * five.first, depth);
  EXPECT_EQ(count.at(0), wall.size());
  EXPECT_EQ(count.at(1), wall.size()) << "the first layer's height within 1 %";
  for (const Vec3& p : result.surface.vertices) {
    if (p.head<2>().norm() < 8.2 || p.head<2>().norm() > 11.8) {
      EXPECT_GT(p.z(), -1e-9);
      continue;
    }
    EXPECT_LT(std::min(std::abs(p.z()), std::abs(p.z() - 30)), 1e-9) << p.transpose();
  }
}

TEST(Layers, OfAWholeBlockMeetAtItsEdges) {
  const LayerHeights three{.count = 3, .first = 0.05, .growth = 1.2};
  const SurfaceMesh scan = analytic::box({4, 3, 2}, 0.2);
  const PipelineResult result = run_pipeline(scan, options_with("", three, 600));
  expect_sound(result, scan);
  EXPECT_EQ(figure(result, "layered_triangles"), static_cast<double>(result.surface.triangles.size()));
  EXPECT_EQ(figure(result, "lower_vertices"), 0);
  const auto count =
      nodes_by_layer(result, three, 1e-7, [](const Vec3& p) { return p.cwiseMin(Vec3(4, 3, 2) - p).minCoeff(); });
  const std::size_t of_surface = result.surface.vertices.size();
  EXPECT_EQ(count, (std::map<int, std::size_t>{{0, of_surface}, {1, of_surface}, {2, of_surface}, {3, of_surface}}));
}

TEST(Layers, TaperOffWhereNoEdgeEndsThem) {
  const PipelineResult result =
      run_pipeline(plate(), options_with("mid=box(10,8,5, 30,22,7)", {.count = 4, .first = 0.1, .growth = 1.3}, 3000));
  expect_sound(result, plate());
  const NamedSet& mid = result.face_sets.front();
  EXPECT_GT(figure(result, "tapered_vertices"), 0);
  // A layer of a wedge has a tetrahedron for each of its corners where the layers do not end.
  std::vector<bool> ends(result.surface.vertices.size(), false);
  for (std::uint32_t f = 0; f < result.surface.triangles.size(); ++f)
    if (!std::ranges::binary_search(mid.members, f))
      for (const std::uint32_t v : result.surface.triangles[f]) ends[v] = true;
  std::size_t corners = 0;
  for (const std::uint32_t f : mid.members)
    for (const std::uint32_t v : result.surface.triangles[f]) corners += ends[v] ? 0 : 1;
  EXPECT_EQ(figure(result, "layer_tetrahedra"), 4.0 * static_cast<double>(corners));
  EXPECT_EQ(figure(result, "largest_move"), 0) << "nothing has to make room";
}

// Of a cone's foot: what makes room for them goes along its side, as near to it as was asked for, or it is an error.
TEST(Layers, KeepADeviationThatWasAskedFor) {
  const double bound = 0.05;
  SurfaceMesh cone = analytic::cylinder(10, 20, 160, 50);
  for (Vec3& p : cone.vertices) p.head<2>() *= 1 - p.z() / 40;
  for (const int order : {1, 2}) {
    PipelineOptions options = options_with("foot=plane(z<0.1)", {.count = 4, .first = 0.2, .growth = 1.3});
    options.simplify->size = LargestDeviation{.distance = bound};
    options.order = order;
    const PipelineResult result = run_pipeline(cone, options);
    EXPECT_GT(figure(result, "layer_tetrahedra"), 0);
    const TetMesh& mesh = *result.volume_mesh;
    const double slope = std::atan(0.25);
    for (std::uint32_t f = 0; f < mesh.boundary.size(); ++f)
      for (const std::uint32_t v : nodes_of_faces(mesh, std::array{f})) {
        const Vec3& p = mesh.nodes[v];
        const double beside = std::abs(p.head<2>().norm() - 10 + p.z() / 4) * std::cos(slope);
        EXPECT_LT(std::min({beside, std::abs(p.z()), std::abs(p.z() - 20)}), bound) << order << ": " << p.transpose();
      }
  }
}

// A patch in the middle of a face tapers off, and is as high as asked for within; the part has room for it.
TEST(Layers, ThatTaperOffHaveRoom) {
  const PipelineResult result =
      run_pipeline(plate(), options_with("mid=box(6,6,5, 34,24,7)", {.count = 3, .first = 0.2, .growth = 1.3}, 3000));
  expect_sound(result, plate());
  EXPECT_EQ(figure(result, "lower_vertices"), 0);
  EXPECT_TRUE(stage_of(result).warnings.empty());
}

// Layers that are higher than a wall, and than the radius of a rod.
class LayersWithoutRoom : public testing::TestWithParam<SurfaceMesh (*)()> {};

TEST_P(LayersWithoutRoom, AreLowerAndToldSo) {
  const SurfaceMesh scan = GetParam()();
  const PipelineResult result = run_pipeline(scan, options_with("", {.count = 3, .first = 1, .growth = 1.5}, 2000));
  expect_sound(result, scan);
  EXPECT_GT(figure(result, "lower_vertices"), 0);
  EXPECT_LT(figure(result, "least_share_of_height"), 0.9);
  ASSERT_EQ(stage_of(result).warnings.size(), 1U);
  EXPECT_THAT(stage_of(result).warnings.front(), HasSubstr("lower than asked for"));
  EXPECT_GT(figure(result, "layer_tetrahedra"), 2 * static_cast<double>(result.surface.triangles.size()));
}

SurfaceMesh rod() {
  return analytic::cylinder(2, 20, 64, 60);
}
SurfaceMesh ring() {
  return analytic::torus(6, 2, 96, 48);
}
INSTANTIATE_TEST_SUITE_P(Of, LayersWithoutRoom, testing::Values(&plate, &rod, &ring));

// Of a ball, whose layers are parallel to its curved sides.
TEST(Layers, OfSecondOrderAreCurvedWithTheSurface) {
  const double radius = 2;
  const SurfaceMesh scan = analytic::sphere(radius, 5);
  const LayerHeights three{.count = 3, .first = 0.02, .growth = 1.4};
  PipelineOptions options = options_with("", three, 800);
  options.order = 2;
  const PipelineResult result = run_pipeline(scan, options);
  const TetMesh& mesh = *result.volume_mesh;
  ASSERT_EQ(mesh.order(), 2);
  EXPECT_NEAR(total_volume(mesh), enclosed_volume(scan), 1e-6 * enclosed_volume(scan));
  const auto in_layers = static_cast<std::size_t>(figure(result, "layer_tetrahedra"));
  EXPECT_EQ(in_layers, 3 * 3 * result.surface.triangles.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    EXPECT_GT(curved_scaled_jacobian(curved_tetrahedron(mesh, t)), 0);
  // Edges are a sixth of the radius, so that their straight middles lie 0.007 deeper: a third of the first layer.
  for (std::size_t t = 0; t < in_layers; ++t)
    for (std::size_t e = 0; e < 6; ++e) {
      const auto [i, j] = tetrahedron_edges[e];
      const auto depth = [&](std::uint32_t v) { return radius - mesh.nodes[v].norm(); };
      const double ends = (depth(mesh.tetrahedra[t][static_cast<std::size_t>(i)]) +
                           depth(mesh.tetrahedra[t][static_cast<std::size_t>(j)])) /
                          2;
      EXPECT_NEAR(depth(mesh.mid_edge_nodes[t][e]), ends, 0.06 * three.first);
    }
}

// Planes stay plane, and what is on no curve stays straight.
TEST(Layers, OfSecondOrderKeepThePlatesPlanes) {
  PipelineOptions options = options_with("top=plane(z>5.9)", five);
  options.order = 2;
  const PipelineResult result = run_pipeline(plate(), options);
  const TetMesh& mesh = *result.volume_mesh;
  EXPECT_NEAR(total_volume(mesh), 7200, 1e-7);
  for (std::uint32_t f = 0; f < mesh.boundary.size(); ++f)
    for (const std::uint32_t v : nodes_of_faces(mesh, std::array{f})) {
      const Vec3& p = mesh.nodes[v];
      EXPECT_LT(p.cwiseMin(Vec3(40, 30, 6) - p).cwiseAbs().minCoeff(), 1e-9) << p.transpose();
    }
}

TEST(Layers, AreTheSameForAnyNumberOfThreads) {
  const PipelineOptions options = options_with("bore=cylinder(r=8+-0.3)", five);
  const PipelineResult many = run_pipeline(pipe(), options);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const PipelineResult alone = run_pipeline(pipe(), options);
  EXPECT_EQ(many.volume_mesh->nodes, alone.volume_mesh->nodes);
  EXPECT_EQ(many.volume_mesh->tetrahedra, alone.volume_mesh->tetrahedra);
}

TEST(LayersRefuse, ASetThatThereIsNot) {
  PipelineOptions options = options_with("top=plane(z>5.9)", five);
  options.layers.front().set = "tip";
  EXPECT_THAT(error_from<WrongUsage>([&] { run_pipeline(plate(), options); }).what(), HasSubstr("tip (limit: top)"));
}

TEST(LayersRefuse, DifferentHeightsThatMeet) {
  PipelineOptions options = options_with("top=plane(z>5.9)", five);
  options.sets.push_back(parse_selection("side=plane(x<0.1)", ""));
  options.layers.push_back({.set = "side", .heights = {.count = 2, .first = 0.2, .growth = 1}});
  const NotMeshable error = error_from<NotMeshable>([&] { run_pipeline(plate(), options); });
  EXPECT_THAT(error.what(), HasSubstr("heights meet"));
  ASSERT_TRUE(error.parts().at);
  EXPECT_NEAR(error.parts().at->x(), 0, 1e-6);
  EXPECT_NEAR(error.parts().at->z(), 6, 1e-6);
}

TEST(LayersRefuse, TwoKindsBehindTheSameTriangles) {
  PipelineOptions options = options_with("top=plane(z>5.9)", five);
  options.layers.push_back({.set = "", .heights = {.count = 2, .first = 0.2, .growth = 1}});
  EXPECT_THAT(error_from<WrongUsage>([&] { run_pipeline(plate(), options); }).what(), HasSubstr("two kinds"));
}

// And the advice helps.
TEST(LayersRefuse, WhatIsTooFlatForSolvers) {
  PipelineOptions options = options_with("top=plane(z>5.9)", {.count = 2, .first = 0.001, .growth = 1});
  const NotMeshable error = error_from<NotMeshable>([&] { run_pipeline(plate(), options); });
  EXPECT_THAT(error.what(), HasSubstr("too flat"));
  ASSERT_TRUE(error.parts().at);
  EXPECT_NEAR(error.parts().at->z(), 6, 1e-6);
  const std::string advice = error.parts().advice;
  options.layers.front().heights.first = std::stod(advice.substr(advice.find("of ") + 3));
  expect_sound(run_pipeline(plate(), options), plate());
}

TEST(LayersRefuse, WhatWouldMoveTheirNodes) {
  for (const char* what : {"--symmetry", "--slide"}) {
    PipelineOptions options = options_with("", five);
    if (what == std::string("--symmetry")) options.symmetry = SymmetryOptions{};
    if (what == std::string("--slide")) options.slide = SlideOptions{.distance = 0.1};
    EXPECT_THAT(error_from<WrongUsage>([&] { run_pipeline(plate(), options); }).what(), HasSubstr(what));
  }
  const PipelineOptions options = options_with("", five);
  EXPECT_THROW(run_pipeline_of_bodies({{"A", plate()}, {"B", analytic::moved(plate(), {0, 0, 6})}}, {}, options),
               WrongUsage);
}

}  // namespace
}  // namespace scan2fea
