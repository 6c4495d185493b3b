// Where the user wants small triangles, whatever the surface's shape: in boxes, in balls, and on both sides of thin
// walls.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <optional>
#include <span>
#include <vector>

namespace scan2fea {

// Edges in it are to be at most this long; model units.
struct SizedBox {
  BoundingBox box;
  double length = 0;
};
struct SizedBall {
  Ball ball;
  double length = 0;
};

struct SizeLimits {
  std::vector<SizedBox> boxes;
  std::vector<SizedBall> balls;
  // Where set, edges are at most this part of the wall's thickness: 1 over the number of elements across it. 1 to 10.
  std::optional<int> elements_across;

  bool empty() const { return boxes.empty() && balls.empty() && !elements_across; }
};

// Halves edges in and around boxes and balls until they are as short there as the result's, so that large triangles
// have vertices that the limits can hold for. `features` are halved with their edges. Throws WrongUsage for limits out
// of range, and for a box or a ball that holds no part of the surface.
void refine_within_limits(SurfaceMesh& scan, std::vector<FeatureEdge>& features, const SizeLimits& limits);

// Per vertex the longest edges that are allowed; infinity where there is no limit. The thickness of a wall
// (quality/wall_thickness.hpp) is measured behind the middles of triangles, and looked for where it matters to edges of
// up to `longest_edge`. Beside edges of the body there is none, so limits there are those of the triangles next to
// them, graded.
// Throws WrongUsage for limits out of range. O(n log n); parallel.
std::vector<double> longest_edges(const SurfaceMesh& scan, const SizeLimits& limits, double longest_edge);

// The wanted lengths, at most `longest`, changing no faster than `gradation`. With `triangles` all others grow alike,
// by up to a half, so that no more triangles than these are needed; where that does not suffice, they are.
std::vector<double> within_limits(const SurfaceMesh& scan, const std::vector<double>& wanted,
                                  std::span<const double> longest, double gradation, std::optional<double> triangles);

}  // namespace scan2fea
