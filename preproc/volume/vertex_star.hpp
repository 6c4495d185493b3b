// The elements around one vertex, seen from it: what moving that vertex needs to know.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/volume/tet_quality.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace scan2fea {

// The faces opposite the vertex x, each such that (f[0], f[1], f[2], x) is a positive tetrahedron.
using StarFaces = std::vector<std::array<Vec3, 3>>;

// The least goal_quality of the star's elements with the vertex at x; like it, exact only above `floor`.
inline double star_quality(const StarFaces& faces, const Vec3& x, double floor = 0) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& f : faces) {
    const double q = goal_quality(f[0], f[1], f[2], x, floor);
    if (q < least) least = q;
    if (least <= floor) break;
  }
  return least;
}

class TetComplex;

// The star of a vertex of the complex, by its elements and as seen from it; returns its least quality.
double look_from(const TetComplex& complex, std::uint32_t v, std::vector<std::uint32_t>& elements, StarFaces& faces);

}  // namespace scan2fea
