// How far one surface lies from another at most: a bound that holds for every point, not for samples of them.
//
// The distance to a convex set is a convex function. So on a triangle abc the distance to a triangle r of the other
// surface is largest at a, b or c, and for any set of candidates r
//   lower = max over corners p of dist(p, surface)  <=  max over abc of dist(., surface)
//         <=  min over candidates r of max over corners p of dist(p, r) = upper.
// Candidates are the triangles nearest to the corners and the middle. Where they do not settle it, the triangle is laid
// over the other surface and parted by what its triangles cover of it, seen along the normal (prism_cover.hpp): the
// height over the triangle bounds all of them at the price of no search, and those beyond the limit are few. Where the
// other surface has a border there, or none of it lies straight below, the triangle is cut instead: where corners have
// different candidates at the place that is equally far from two of them, which is where it crosses from one to the
// next, and the parts are bounded again. (The bound by candidates is that of Guthe, Borodin and Klein, "Fast and
// accurate Hausdorff distance calculation between meshes", 2005.)
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/prism_cover.hpp"
#include "quality/triangle_tree.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// A surface made ready to be measured against, again and again: its tree and who lies beside whom.
class DeviationReference {
 public:
  // The mesh must outlive this and stay as it is. Throws InvalidInput where it has no triangle. O(n log n).
  explicit DeviationReference(const SurfaceMesh& mesh);

  const SurfaceMesh& mesh() const { return mesh_; }
  const TriangleTree& tree() const { return tree_; }
  const BoundingBox& box() const { return box_; }
  const LeafEdges& edges() const { return edges_; }

 private:
  const SurfaceMesh& mesh_;
  TriangleTree tree_;
  LeafEdges edges_;
  BoundingBox box_;
};

struct DeviationBoundOptions {
  // Bounds that do not exceed this need not be close, which saves most of the time: model units, 0 or more. For the
  // question whether a deviation of D is kept, D.
  double limit = 0;
  // Above the limit, how far the upper bound may lie above the lower one, over the larger of the lower bound and the
  // limit; in (0, 1]. For the question which triangles are beyond the limit, and about how far, 0.3 does with half of
  // the time where many are; where none is, it makes no difference.
  double tolerance = 0.02;
};

// From all points of one surface to the other.
struct OneSidedDeviation {
  // Per triangle of the one surface, bounds of the distance of its farthest point: model units.
  std::vector<double> lower, upper;
  std::vector<Vec3> farthest;  // the farthest of its points that were met, at distance `lower`
  double largest_lower = 0, largest_upper = 0;
  std::uint32_t worst_face = 0;  // where the upper bound is largest
};

struct DeviationBound {
  OneSidedDeviation to_reference;  // per triangle of the mesh
  OneSidedDeviation to_mesh;       // per triangle of the reference
  double lower() const;            // the Hausdorff distance is at least this
  double upper() const;            // and at most this, up to rounding (about 1e-14 of the coordinates)
  bool holds(double distance) const { return upper() <= distance; }
  const OneSidedDeviation& worse_side() const;
};

// Throws InvalidInput where a surface has no triangle, WrongUsage for options out of range. Orientation and topology do
// not matter; triangles without area are bounded as segments or points. Parallel; the same for any number of threads.
// About 1 us a triangle and thread, and 50 ns for each of the other surface's triangles that it lies over; beyond the
// limit some searches of the nearest triangle more, so that a large tolerance costs less. Pieces smaller than the
// tolerance are never cut, so it ends. Distances below 1e-7 of the reference's diagonal are not told from each other.
DeviationBound bound_deviation(const SurfaceMesh& mesh, const SurfaceMesh& reference,
                               const DeviationBoundOptions& options);

// The same for a reference that was made ready before.
DeviationBound bound_deviation(const SurfaceMesh& mesh, const DeviationReference& reference,
                               const DeviationBoundOptions& options);

// One of the two sides: from all points of `from` to `onto`.
OneSidedDeviation bound_one_sided_deviation(const SurfaceMesh& from, const SurfaceMesh& onto,
                                            const DeviationBoundOptions& options);
OneSidedDeviation bound_one_sided_deviation(const SurfaceMesh& from, const DeviationReference& onto,
                                            const DeviationBoundOptions& options);

}  // namespace scan2fea
