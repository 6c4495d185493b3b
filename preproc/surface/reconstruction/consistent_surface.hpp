// The closed surface through points that holds together best.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/primitives/find_primitives.hpp"
#include "preproc/surface/reconstruction/seen_cells.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace scan2fea {

struct ConsistentSurface {
  std::vector<Triangle> triangles;         // closed, oriented outwards, free of crossings
  std::vector<bool> is_made_up;            // of each: no front has it, nor a part's shapes: it closes a gap
  std::size_t bodies = 0;                  // pieces that hang together
  std::vector<std::uint32_t> off_surface;  // points that lie off it by half of the spacing
  std::size_t pinched_edges = 0;           // where it met itself (pinches.hpp)
  std::size_t overlong = 0;                // triangles whose longest edge is more than `long_for_spacing` spacings
  Primitives shapes;                       // of a part of up to 20,000 points; else none in its list
  std::string choice;                      // which it is of how many, and why
};

inline constexpr double long_for_spacing = 3.5;

// The longest edge, over the spacing at that corner where this is largest.
double length_in_spacings(const std::vector<Vec3>& points, const std::vector<double>& spacing, const Triangle& t);

// Advancing fronts with several values of `beta`, each made a closed surface by a minimum cut, and all of them
// together: fronts are unstable where points are few, and what they agree on is mostly right. Of these surfaces the one
// that has the least of bodies beyond the first (ten each), points off it, edges where it met itself and overlong
// triangles; all together where it is as good as any, and alone where nothing is wrong with it. On a part of up to
// 20,000 points that is cut once more by what its shapes tell of inside and outside (cell_sides.hpp), and kept so
// unless much more is wrong then: a hole of which few points are known is empty, and walls stand where faces say so; on
// a free form as small by the points' normals (seen_cells.hpp), which the surface itself tells where none came with the
// points. `views`: what came with them. Throws NotMeshable where there is no surface. About 200 us a point; parallel in
// part, the same for any number of threads.
ConsistentSurface find_consistent_surface(const std::vector<Vec3>& points, const std::vector<double>& spacing,
                                          const PointViews& views, const Progress& progress);

// The same by one cut, from a surface through most of these points, where some have gone or come since. Empty where
// nothing is inside. About 40 us a point.
ConsistentSurface renew_surface(const std::vector<Vec3>& points, const std::vector<double>& spacing,
                                const ConsistentSurface& before, const PointViews& views, const Progress& progress);

}  // namespace scan2fea
