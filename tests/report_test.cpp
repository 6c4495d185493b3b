#include "quality/report.hpp"

#include "quality/gates.hpp"
#include "tests/analytic_meshes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace scan2fea {
namespace {

std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> names;
  for (const auto& [key, value] : json.items()) names.push_back(key);
  return names;
}

TetMesh cube_corner() {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  return mesh;
}

Report full_report() {
  const SurfaceMesh mesh = analytic::torus(3, 1, 20, 10);
  Report report;
  report.input = "torus.ply";
  report.surface = measure_surface(mesh);
  report.deviation = measure_deviation(mesh, mesh, {.samples = 100, .seed = 1});
  report.volume_mesh = measure_tetrahedra(cube_corner());
  report.regions = {{"HUB", 2.5, 7}};
  return report;
}

TEST(Report, HoldsTheContractsKeys) {
  const Json json = to_json(full_report());
  EXPECT_THAT(keys(json),
              testing::ElementsAre("schema", "input", "surface", "deviation", "volume_mesh", "regions", "gates"));
  EXPECT_THAT(
      keys(json["surface"]),
      testing::IsSupersetOf({"vertices", "faces", "edge_ratio", "min_angle_deg", "max_angle_deg", "radius_ratio",
                             "closed", "manifold", "self_intersections", "components", "genus", "volume", "area"}));
  EXPECT_THAT(keys(json["surface"]["edge_ratio"]), testing::ElementsAre("mean", "p50", "p95", "p99", "max"));
  EXPECT_THAT(keys(json["deviation"]), testing::IsSupersetOf({"volume_difference_pct", "area_difference_pct",
                                                              "hausdorff_pct_diagonal", "rms_pct_diagonal"}));
  EXPECT_THAT(keys(json["volume_mesh"]),
              testing::ElementsAre("nodes", "tetrahedra", "order", "min_dihedral_deg", "max_dihedral_deg",
                                   "min_face_angle_deg", "max_face_angle_deg", "scaled_jacobian", "edge_ratio",
                                   "radius_edge_ratio", "volume", "inverted"));
  EXPECT_THAT(keys(json["regions"][0]), testing::ElementsAre("name", "area", "faces"));
}

TEST(Report, SaysWhatTheSurfaceIs) {
  const Json surface = to_json(full_report())["surface"];
  EXPECT_EQ(surface["faces"], 400);
  EXPECT_EQ(surface["closed"], true);
  EXPECT_EQ(surface["manifold"], true);
  EXPECT_EQ(surface["genus"], 1);
  EXPECT_EQ(surface["self_intersections"], 0);
  EXPECT_DOUBLE_EQ(surface["volume"], enclosed_volume(analytic::torus(3, 1, 20, 10)));
}

TEST(Report, WhatIsNotKnownIsNullOrLeftOut) {
  SurfaceMesh open = analytic::sphere(1, 1);
  open.triangles.pop_back();
  Report report;
  report.surface = measure_surface(open);
  const Json json = to_json(report);
  EXPECT_TRUE(json["surface"]["genus"].is_null());
  EXPECT_TRUE(json["surface"]["volume"].is_null());
  EXPECT_FALSE(json.contains("deviation"));
  EXPECT_FALSE(json.contains("volume_mesh"));
}

TEST(Report, NothingIsInfiniteOrNotANumber) {
  Report report;
  report.surface = measure_surface({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}});
  report.surface->area = std::numeric_limits<double>::infinity();
  report.deviation.emplace().rms_pct_diagonal = std::numeric_limits<double>::quiet_NaN();
  const Json json = to_json(report);
  EXPECT_TRUE(json["surface"]["area"].is_null());
  EXPECT_TRUE(json["surface"]["edge_ratio"]["mean"].is_null());
  EXPECT_TRUE(json["deviation"]["rms_pct_diagonal"].is_null());
  EXPECT_EQ(json["surface"]["degenerate"], 1);
}

TEST(Report, NumbersRoundTripThroughText) {
  const Json json = to_json(full_report());
  EXPECT_EQ(Json::parse(json.dump()), json);
}

TEST(Report, TheTableNamesWhatIsThere) {
  Json json = to_json(full_report());
  json["gates"] = to_json(evaluate_gates({parse_gate("genus==0")}, json));
  const std::string table = to_table(json);
  EXPECT_THAT(table, testing::HasSubstr("torus.ply"));
  EXPECT_THAT(table, testing::HasSubstr("400 triangles"));
  EXPECT_THAT(table, testing::HasSubstr("HUB"));
  EXPECT_THAT(table, testing::HasSubstr("FAIL"));
  EXPECT_THAT(to_table(to_json(Report{})), testing::Not(testing::HasSubstr("edge ratio")));
}

}  // namespace
}  // namespace scan2fea
