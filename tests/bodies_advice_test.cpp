// What an error about bodies advises works when it is followed, whatever does not fit.
#include "preproc/bodies_pipeline.hpp"
#include "preproc/mesh/error.hpp"
#include "tests/assemblies.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace scan2fea {
namespace {

using analytic::box_at;
using analytic::moved;

SurfaceMesh tilted(SurfaceMesh mesh, double angle_deg) {
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180, Vec3(1, 0.3, 0.1).normalized()));
  for (Vec3& p : mesh.vertices) p = turn * p;
  return mesh;
}

struct Misfit {
  std::string name;
  std::vector<Body> bodies;
};

// Press fits, loose pins, plates that sink in or hang above, tilted ones, bars that cross, balls too large or too small
// for their sockets, thin bodies between.
std::vector<Misfit> misfits() {
  std::vector<Misfit> all;
  const SurfaceMesh bracket = analytic::bored_block({30, 20, 10}, 5, 64, 3), base = box_at({10, 8, 2}, 1, {0, 0, 0});
  for (const double off : {-0.3, -0.05, -0.01, -0.004, 0.004, 0.01, 0.03, 0.3})
    all.push_back({"pin of radius 5 + " + std::to_string(off),
                   {{"BRACKET", bracket}, {"PIN", moved(analytic::cylinder(5 + off, 24, 50, 8), {0, 0, -7})}}});
  for (const double off : {-1.0, -0.3, -0.02, -0.001, 0.0005, 0.001, 0.01})
    all.push_back({"box at " + std::to_string(off), {{"BASE", base}, {"TOP", box_at({4, 3, 5}, 0.7, {3, 2, 2 + off})}}});
  for (const double angle : {0.02, 0.2, 2.0, 10.0, 40.0})
    all.push_back({"box tilted by " + std::to_string(angle),
                   {{"BASE", base}, {"TOP", moved(tilted(box_at({4, 3, 5}, 0.7, {0, 0, 0}), angle), {3, 2, 2})}}});
  for (const double off : {-0.05, -0.01, 0.01, 0.05})
    all.push_back({"foil at " + std::to_string(off),
                   {{"BASE", base}, {"FOIL", box_at({4, 3, 0.2}, 0.7, {3, 2, 2 + off})}}});
  for (const double off : {-0.2, -0.03, 0.03, 0.2})
    all.push_back({"ball of radius 5 + " + std::to_string(off),
                   {{"SOCKET", analytic::join(analytic::sphere(8, 4), analytic::reversed(analytic::sphere(5, 4)))},
                    {"BALL", analytic::sphere(5 + off, 3)}}});
  all.push_back({"bars", {{"A", box_at({10, 1, 1}, 1, {0, 0, 0})}, {"B", box_at({1, 10, 1}, 0.9, {4, -4, 0.3})}}});
  all.push_back({"one in another", {{"A", base}, {"B", box_at({2, 2, 1}, 0.6, {3, 3, 0.5})}}});
  return all;
}

std::vector<Body> placed(std::vector<Body> bodies, double scale) {
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(1.1 * scale, Vec3(1, 2, 3).normalized()));
  for (Body& body : bodies)
    for (Vec3& p : body.surface.vertices) p = (scale * (turn * p + Vec3(7, -3, 11))).cast<float>().cast<double>();
  return bodies;
}

// The error's advice; nothing where a mesh came out.
std::optional<std::string> advice_for(const std::vector<Body>& bodies, const JoinOptions& joining) {
  PipelineOptions options;
  options.simplify->effort = Effort::low;
  try {
    const PipelineResult result = run_pipeline_of_bodies(bodies, joining, options);
    EXPECT_TRUE(result.volume_mesh);
    for (const MadeBody& body : result.bodies)
      EXPECT_NEAR(body.volume, body.volume_of_scan, 1.01 * most_volume_change * body.volume_of_scan) << body.name;
    return {};
  } catch (const NotMeshable& error) {
    EXPECT_FALSE(error.parts().advice.empty()) << error.what();
    return error.what();
  }
}

std::vector<double> tolerances_in(const std::string& advice) {
  const std::string flag = "--contact ";
  std::vector<double> found;
  for (std::size_t at = 0; (at = advice.find(flag, at)) != std::string::npos; at += flag.size())
    found.push_back(std::stod(advice.substr(at + flag.size())));
  return found;
}

bool becomes_one_body(const std::vector<Body>& bodies) {
  SurfaceMesh all;
  for (const Body& body : bodies) all = analytic::join(all, body.surface);
  PipelineOptions options;
  options.simplify->effort = Effort::low;
  return run_pipeline(all, options).volume_mesh.has_value();
}

TEST(BodiesAdvice, WorksWhenItIsFollowed) {
  for (const Misfit& misfit : misfits())
    for (const double scale : {1.0, 0.01}) {
      SCOPED_TRACE(misfit.name + ", times " + std::to_string(scale));
      const std::vector<Body> bodies = placed(misfit.bodies, scale);
      const std::optional<std::string> failure = advice_for(bodies, {});
      if (!failure) continue;
      const std::vector<double> tolerances = tolerances_in(*failure);
      for (const double tolerance : tolerances) {
        const auto again = advice_for(bodies, {.tolerance = tolerance});
        EXPECT_FALSE(again) << *failure << "\nthen " << again.value_or("");
      }
      if (tolerances.empty()) {
        ASSERT_NE(failure->find("--one-body"), std::string::npos) << *failure;
        EXPECT_TRUE(becomes_one_body(bodies)) << *failure;
      }
    }
}

}  // namespace
}  // namespace scan2fea
