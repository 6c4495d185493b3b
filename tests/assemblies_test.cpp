// Thirty assemblies of bodies that touch, as they were made, and turned and moved in single precision. The test prints
// a table of what came out.
#include "tests/assemblies.hpp"

#include "preproc/bodies_pipeline.hpp"
#include "quality/tetrahedron_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace scan2fea {
namespace {

using analytic::Assembly;

std::vector<Assembly> all_assemblies() {
  std::vector<Assembly> all = analytic::plane_assemblies();
  for (const auto& more : {analytic::round_assemblies(), analytic::wavy_assemblies()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::vector<Body> placed(std::vector<Body> bodies, int position) {
  if (position == 0) return bodies;
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(0.37 * position, Vec3(1, 2, 3 + position).normalized()));
  for (Body& body : bodies)
    for (Vec3& p : body.surface.vertices) p = (turn * p + Vec3(7, -3, 11) * position).cast<float>().cast<double>();
  return bodies;
}

TEST(Assemblies, AllConformAndKeepTheirVolumes) {
  std::vector<double> angles;
  double largest_difference = 0;  // of a volume
  std::printf("| assembly | tetrahedra | between | smallest dihedral angle |\n|---|---|---|---|\n");
  for (const Assembly& assembly : all_assemblies())
    for (const int position : {0, 2}) {
      const std::vector<Body> bodies = placed(assembly.bodies, position);
      SCOPED_TRACE(assembly.name + ", position " + std::to_string(position));
      const PipelineResult result = run_pipeline_of_bodies(bodies, assembly.joining);
      const TetMesh& mesh = *result.volume_mesh;
      EXPECT_EQ(find_boundary(mesh.tetrahedra).size(), mesh.outer_faces());
      EXPECT_GT(mesh.faces_between, 0U);
      const TetSummary shape = measure_tetrahedra(mesh);
      EXPECT_EQ(shape.inverted, 0U);
      angles.push_back(shape.min_dihedral_deg);
      for (std::size_t b = 0; b < bodies.size(); ++b) {
        double volume = 0;
        for (const std::uint32_t t : mesh.element_sets[b].members) volume += volume_of(mesh, t);
        const double difference = std::abs(volume / result.bodies[b].volume_joined - 1);
        EXPECT_LT(difference, 1e-4) << bodies[b].name;
        largest_difference = std::max(largest_difference, difference);
      }
      if (position == 0)
        std::printf("| %s | %zu | %zu | %.1f |\n", assembly.name.c_str(), mesh.tetrahedra.size(), mesh.faces_between,
                    shape.min_dihedral_deg);
    }
  std::sort(angles.begin(), angles.end());
  std::printf("%zu meshes: smallest dihedral angle %.1f, in the median %.1f degrees; volumes within %.4f %%\n",
              angles.size(), angles.front(), angles[angles.size() / 2], 100 * largest_difference);
  EXPECT_GT(angles.front(), 15);
}

}  // namespace
}  // namespace scan2fea
