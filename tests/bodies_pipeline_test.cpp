// From several bodies that touch to one mesh: a set of elements each, and shared triangles where they touch.
#include "preproc/bodies_pipeline.hpp"

#include "preproc/mesh/error.hpp"
#include "quality/deviation.hpp"
#include "quality/self_intersections.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "tests/touching_bodies.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace scan2fea {
namespace {

using analytic::moved;

SurfaceMesh box(double x, double y, double z, double edge, const Vec3& at) {
  return moved(analytic::box({x, y, z}, edge), at);
}

SurfaceMesh turned(SurfaceMesh mesh, double angle) {
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(angle, Vec3(1, 2, 3).normalized()));
  for (Vec3& p : mesh.vertices) p = turn * p;
  return mesh;
}

struct Case {
  std::string name;
  std::vector<Body> bodies;
  std::vector<std::pair<std::string, double>> interfaces;  // and their areas
  double area_tolerance = 1e-9;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

constexpr double pi = std::numbers::pi;

std::vector<Case> cases() {
  const Body bracket{"BRACKET", analytic::bored_block({30, 20, 10}, 5, 128, 4)};
  const SurfaceMesh coat = analytic::join(analytic::sphere(10, 5), analytic::reversed(analytic::sphere(8, 5)));
  return {
      {"PinThroughABracket",
       {bracket, {"PIN", moved(analytic::cylinder(5, 24, 120, 8), {0, 0, -7})}},
       {{"INTERFACE_BRACKET_PIN", 100 * pi}},
       1.5e-2},
      {"FlushPin",
       {bracket, {"PIN", analytic::cylinder(5, 10, 120, 4)}},
       {{"INTERFACE_BRACKET_PIN", 100 * pi}},
       1.5e-2},
      {"PinThatEndsInTheBore",
       {bracket, {"PIN", moved(analytic::cylinder(5, 12, 120, 4), {0, 0, 4})}},
       {{"INTERFACE_BRACKET_PIN", 60 * pi}},
       1.5e-2},
      {"StackedBoxes",
       {{"BASE", box(10, 8, 2, 1, {0, 0, 0})}, {"TOP", box(4, 3, 5, 0.7, {3, 2, 2})}},
       {{"INTERFACE_BASE_TOP", 12}}},
      {"BoxesThatOverhang",
       {{"BASE", box(10, 8, 2, 1, {0, 0, 0})}, {"TOP", box(9, 9, 3, 0.7, {4, -3, 2})}},
       {{"INTERFACE_BASE_TOP", 36}}},
      {"CoatedBall",
       {{"COAT", coat}, {"CORE", turned(analytic::sphere(8, 5), 0.3)}},
       {{"INTERFACE_COAT_CORE", 256 * pi}},
       5e-3},
      {"PlateOnARod",
       {{"ROD", analytic::cylinder(4, 20, 96, 12)}, {"PLATE", box(14, 12, 2, 1, {-7, -6, 20})}},
       {{"INTERFACE_ROD_PLATE", 16 * pi}},
       5e-3},
      {"ThreeBlocks",
       {{"A", box(4, 3, 2, 1, {0, 0, 0})}, {"B", box(5, 3, 2, 0.7, {4, 0, 0})}, {"C", box(2, 3, 2, 5, {9, 0, 0})}},
       {{"INTERFACE_A_B", 6}, {"INTERFACE_B_C", 6}}},
      {"BrickOnTwoOthers",
       {{"LEFT", box(5, 4, 2, 1, {0, 0, 0})},
        {"RIGHT", box(5, 4, 2, 1.3, {5, 0, 0})},
        {"TOP", box(6, 4, 2, 1.1, {2, 0, 2})}},
       {{"INTERFACE_LEFT_RIGHT", 8}, {"INTERFACE_LEFT_TOP", 12}, {"INTERFACE_RIGHT_TOP", 12}}},
      {"T",
       {{"WEB", box(20, 2, 10, 1, {0, -1, 0})}, {"FLANGE", box(24, 8, 2, 1.5, {-2, -4, 10})}},
       {{"INTERFACE_WEB_FLANGE", 40}}},
      {"Apart", {{"A", box(4, 3, 2, 1, {0, 0, 0})}, {"B", box(5, 3, 2, 0.7, {6, 0, 0})}}, {}},
  };
}

// How often each face of the elements of a set is one of its elements'.
std::map<Triangle, int> faces_of(const TetMesh& mesh, const NamedSet& elements) {
  std::map<Triangle, int> faces;
  for (const std::uint32_t t : elements.members)
    for (const auto& local : tetrahedron_faces) {
      Triangle f;
      for (std::size_t k = 0; k < 3; ++k) f[k] = mesh.tetrahedra[t][static_cast<std::size_t>(local[k])];
      std::sort(f.begin(), f.end());
      ++faces[f];
    }
  return faces;
}

double volume_of(const TetMesh& mesh, const NamedSet& elements) {
  TetMesh part = mesh;
  part.tetrahedra.clear();
  for (const std::uint32_t t : elements.members) part.tetrahedra.push_back(mesh.tetrahedra[t]);
  return total_volume(part);
}

class Bodies : public testing::TestWithParam<Case> {};

TEST_P(Bodies, ShareTheTrianglesWhereTheyTouch) {
  const Case& c = GetParam();
  const PipelineResult result = run_pipeline_of_bodies(c.bodies);
  ASSERT_TRUE(result.volume_mesh);
  const TetMesh& mesh = *result.volume_mesh;
  std::vector<std::map<Triangle, int>> faces;
  std::size_t elements = 0;
  ASSERT_EQ(mesh.element_sets.size(), c.bodies.size());
  for (std::size_t b = 0; b < c.bodies.size(); ++b) {
    const NamedSet& set = mesh.element_sets[b];
    EXPECT_EQ(set.name, c.bodies[b].name);
    const double volume = enclosed_volume(c.bodies[b].surface);
    EXPECT_NEAR(volume_of(mesh, set), volume, 1e-3 * volume) << set.name;
    faces.push_back(faces_of(mesh, set));
    elements += set.members.size();
  }
  EXPECT_EQ(elements, mesh.tetrahedra.size());
  EXPECT_EQ(find_boundary(mesh.tetrahedra).size(), mesh.outer_faces());

  ASSERT_EQ(mesh.face_sets.size(), c.interfaces.size());
  std::size_t shared = 0;
  for (std::size_t s = 0; s < c.interfaces.size(); ++s) {
    const NamedSet& set = mesh.face_sets[s];
    EXPECT_EQ(set.name, c.interfaces[s].first);
    double area = 0;
    std::set<std::size_t> of_bodies;
    for (const std::uint32_t f : set.members) {
      ASSERT_GE(f, mesh.outer_faces());
      Triangle t = boundary_triangle(mesh, mesh.boundary[f]);
      std::sort(t.begin(), t.end());
      std::size_t bodies = 0;
      for (std::size_t b = 0; b < faces.size(); ++b) {
        const auto at = faces[b].find(t);
        if (at == faces[b].end()) continue;
        EXPECT_EQ(at->second, 1);
        of_bodies.insert(b);
        ++bodies;
      }
      EXPECT_EQ(bodies, 2U);
      area += face_area(mesh, mesh.boundary[f]);
    }
    EXPECT_EQ(of_bodies.size(), 2U);
    EXPECT_NEAR(area, c.interfaces[s].second, c.area_tolerance * c.interfaces[s].second) << set.name;
    shared += set.members.size();
  }
  EXPECT_EQ(shared, mesh.faces_between);
  const TetSummary shape = measure_tetrahedra(mesh);
  EXPECT_GT(shape.min_dihedral_deg, 20);
  EXPECT_EQ(shape.inverted, 0U);
}

TEST(BodiesPipeline, MidEdgeNodesOfInterfacesAreSharedAndOnThem) {
  PipelineOptions options;
  options.order = 2;
  const std::vector<Body> bodies = cases()[0].bodies;
  const PipelineResult result = run_pipeline_of_bodies(bodies, {}, options);
  const TetMesh& mesh = *result.volume_mesh;
  double largest = 0;
  for (const std::uint32_t n : nodes_of_faces(mesh, mesh.face_sets[0].members))
    largest = std::max(largest, std::abs(mesh.nodes[n].head<2>().norm() - 5));
  EXPECT_LT(largest, 0.002 * std::sqrt(30. * 30 + 20 * 20 + 24 * 24));
  EXPECT_NEAR(result.sets[0].area, 100 * pi, 0.2);
}

// Two parts of one ball, and a pin in its bore, of so many triangles that what they stand for is round.
std::vector<std::vector<Body>> round_bodies() {
  const SurfaceMesh shell = analytic::join(analytic::sphere(10, 5), analytic::reversed(analytic::sphere(6, 5)));
  return {{{"SHELL", shell}, {"BALL", turned(analytic::sphere(6, 5), 0.4)}},
          {{"BRACKET", analytic::bored_block({30, 20, 10}, 5, 256, 30)},
           {"PIN", moved(analytic::cylinder(5, 24, 200, 40), {0, 0, -7})}}};
}

TEST(BodiesPipeline, CurvedSidesAreFittedBetweenBodiesToo) {
  for (const std::vector<Body>& bodies : round_bodies()) {
    SCOPED_TRACE(bodies[0].name);
    double rms_of_straight = 0;
    for (const int order : {1, 2}) {
      PipelineOptions options;
      options.order = order;
      const PipelineResult result = run_pipeline_of_bodies(bodies, {}, options);
      const TetMesh& mesh = *result.volume_mesh;
      const Deviation deviation =
          measure_deviation(mesh, result.reference(), {.samples = 50000, .reference_is_of_bodies = true});
      if (order == 1)
        rms_of_straight = deviation.rms_pct_diagonal;
      else
        EXPECT_LT(deviation.rms_pct_diagonal, 0.4 * rms_of_straight);
      for (std::size_t b = 0; b < bodies.size(); ++b)
        EXPECT_NEAR(result.bodies[b].volume, result.bodies[b].volume_joined, 1e-6 * result.bodies[b].volume_joined)
            << bodies[b].name << " of order " << order;
      EXPECT_NEAR(total_volume(mesh), result.bodies[0].volume + result.bodies[1].volume, 1e-9 * total_volume(mesh));
      const TetSummary shape = measure_tetrahedra(mesh);
      EXPECT_EQ(shape.inverted, 0U);
      EXPECT_GT(shape.scaled_jacobian.min, 0.15);
    }
  }
}

TEST(BodiesPipeline, ADeviationThatIsRequiredHoldsForInterfacesToo) {
  PipelineOptions options;
  options.simplify->size = LargestDeviation{.distance = 0.03};
  const PipelineResult result = run_pipeline_of_bodies(cases()[0].bodies, {}, options);
  for (const StageRecord& record : result.stages)
    for (const auto& [name, value] : record.changes)
      if (name == "largest_deviation") {
        EXPECT_LE(value, 0.03) << record.name;
      }
  const TetMesh& mesh = *result.volume_mesh;
  for (const std::uint32_t n : nodes_of_faces(mesh, mesh.face_sets[0].members))
    EXPECT_NEAR(mesh.nodes[n].head<2>().norm(), 5, 0.04);
}

TEST(BodiesPipeline, BodiesThatTouchAtALineOrAPointAreMeshedAndTold) {
  SurfaceMesh ball = analytic::sphere(3, 3);
  double lowest = 0;
  for (const Vec3& p : ball.vertices) lowest = std::min(lowest, p.z());
  ball = moved(ball, {5, 4, 2 - lowest});
  const Body base{"BASE", box(10, 8, 2, 1, {0, 0, 0})};
  for (const Body& other : {Body{"BY_AN_EDGE", box(4, 8, 3, 0.9, {10, 0, 2})},
                            Body{"BY_A_CORNER", box(4, 4, 3, 0.9, {10, 8, 2})}, Body{"BALL", ball}}) {
    const PipelineResult result = run_pipeline_of_bodies({base, other});
    EXPECT_EQ(result.touches.size(), 1U) << other.name;
    EXPECT_TRUE(result.contacts.empty()) << other.name;
    const TetMesh& mesh = *result.volume_mesh;
    EXPECT_EQ(find_boundary(mesh.tetrahedra).size(), mesh.outer_faces());
    EXPECT_GT(measure_tetrahedra(mesh).min_dihedral_deg, 20) << other.name;
    for (const MadeBody& body : result.bodies)
      EXPECT_NEAR(body.volume, body.volume_of_scan, 1e-5 * body.volume_of_scan) << other.name;
  }
}

double farthest_off_plane(const TetMesh& mesh, const NamedSet& set, double z) {
  double farthest = 0;
  for (const std::uint32_t n : nodes_of_faces(mesh, set.members))
    farthest = std::max(farthest, std::abs(mesh.nodes[n].z() - z));
  return farthest;
}

// Boards, laminates, gaskets.
TEST(BodiesPipeline, LayersMeetInPlanes) {
  for (const double thickness : {0.4, 1.0, 3.0}) {
    std::vector<Body> layers;
    for (int k = 0; k < 3; ++k)
      layers.push_back({"L" + std::to_string(k), box(40, 40, thickness, 50, {0, 0, k * thickness})});
    const PipelineResult result = run_pipeline_of_bodies(layers);
    const TetMesh& mesh = *result.volume_mesh;
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_LT(farthest_off_plane(mesh, mesh.face_sets[k], static_cast<double>(k + 1) * thickness), 1e-9) << thickness;
    for (const MadeBody& body : result.bodies)
      EXPECT_NEAR(body.volume, 1600 * thickness, 1e-6 * 1600 * thickness) << thickness;
    EXPECT_EQ(measure_tetrahedra(mesh).inverted, 0U);
  }
}

TEST(BodiesPipeline, SetsOfTheUserAreOnTheOutside) {
  PipelineOptions options;
  options.sets = {parse_selection("fixed=plane(x<-14.99)", "mm"), parse_selection("pushed=plane(z>16.99)", "mm")};
  const PipelineResult result = run_pipeline_of_bodies(cases()[0].bodies, {}, options);
  ASSERT_EQ(result.sets.size(), 3U);
  EXPECT_NEAR(result.sets[0].area, 200, 1e-6);
  EXPECT_NEAR(result.sets[1].area, 25 * pi, 0.02 * 25 * pi);
  const TetMesh& mesh = *result.volume_mesh;
  for (const std::uint32_t f : mesh.face_sets[0].members)
    for (const std::uint32_t n : boundary_triangle(mesh, mesh.boundary[f])) EXPECT_NEAR(mesh.nodes[n].x(), -15, 1e-9);
}

TEST(BodiesPipeline, AHoleAndACavityStayEmpty) {
  const SurfaceMesh hollow =
      analytic::join(box(10, 8, 6, 1, {0, 0, 0}), analytic::reversed(box(2, 2, 2, 0.5, {4, 3, 2})));
  const std::vector<Body> bodies{{"HOLLOW", hollow}, {"TOP", box(4, 3, 5, 0.7, {3, 2, 6})}};
  const TetMesh mesh = *run_pipeline_of_bodies(bodies).volume_mesh;
  EXPECT_NEAR(volume_of(mesh, mesh.element_sets[0]), 480 - 8, 1e-6);
  EXPECT_NEAR(volume_of(mesh, mesh.element_sets[1]), 60, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Bodies, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<Case>& shape) { return shape.param.name; });

}  // namespace
}  // namespace scan2fea
