// Surfaces with one thing wrong, and what repair has to make of them.
#pragma once

#include "preproc/surface/repair/repair.hpp"
#include "quality/self_intersections.hpp"
#include "quality/validity.hpp"
#include "tests/analytic_meshes.hpp"
#include "tests/error_from.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace scan2fea {

inline void expect_sound(const SurfaceMesh& mesh) {
  const SurfaceValidity validity = check_validity(mesh);
  EXPECT_TRUE(validity.closed());
  EXPECT_TRUE(validity.manifold());
  EXPECT_EQ(validity.unused_vertices, 0u);
  EXPECT_TRUE(find_self_intersections(mesh).empty());
  EXPECT_GT(enclosed_volume(mesh), 0);
}

inline SurfaceMesh unit_box(int squares_per_side) {
  return analytic::box(Vec3::Ones(), 1.0 / squares_per_side);
}

template <class Predicate>
SurfaceMesh without_faces(SurfaceMesh mesh, const Predicate& gone) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return gone((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  });
  return mesh;
}

// One index for each place.
inline SurfaceMesh welded(SurfaceMesh mesh) {
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t)
      v = static_cast<std::uint32_t>(std::find(mesh.vertices.begin(), mesh.vertices.end(), Vec3(mesh.vertices[v])) -
                                     mesh.vertices.begin());
  return mesh;
}

// Each face with vertices of its own.
inline SurfaceMesh torn(const SurfaceMesh& mesh) {
  SurfaceMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto n = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  return soup;
}

inline RepairOptions closing_all() {
  RepairOptions options;
  options.largest_hole_of_diagonal.reset();
  return options;
}

inline std::string message_of_failure(SurfaceMesh mesh, const RepairOptions& options = {}) {
  return error_from<NotMeshable>([&] { repair(mesh, options); }).what();
}

}  // namespace scan2fea
