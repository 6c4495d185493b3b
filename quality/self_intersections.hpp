// Pairs of faces that pass through or touch one another where they should not.
//
// Two faces intersect if they have a point in common beyond the vertices and the edge that they share by index. Exact:
// the same meaning, and the same pairs, as CGAL's Polygon_mesh_processing::self_intersections. Coincident vertices with
// different indices are different vertices, so unwelded seams intersect all along.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// face <= other; equal for a face whose corners are collinear, which is reported by itself and tested against no other.
struct FacePair {
  std::uint32_t face;
  std::uint32_t other;
  auto operator<=>(const FacePair&) const = default;
};

// All pairs, ascending. About O(n log n) for surfaces; parallel, the result does not depend on the number of threads.
// Precondition: finite coordinates, indices in range.
std::vector<FacePair> find_self_intersections(const SurfaceMesh& mesh);

// Only the pairs with a face of `faces` (in any order), for a check after a local change: O(n) with a small constant
// for the pass over the mesh, the rest by the number of `faces`.
std::vector<FacePair> find_self_intersections(const SurfaceMesh& mesh, std::span<const std::uint32_t> faces);

// The test of one pair, for stages that keep a surface sound step by step: whether two faces with corners among
// `points` intersect in the sense above. Precondition: neither is collinear.
bool faces_intersect(const std::vector<Vec3>& points, const Triangle& s, const Triangle& t);

// Exact.
bool is_collinear(const std::vector<Vec3>& points, const Triangle& t);

}  // namespace scan2fea
