// How thick a body is behind a place of its surface, and which triangle lies on the other side.
//
// There is one definition for all that ask: the largest ball inside the body that touches the surface at the place. It
// is found by shrinking (Ma, Bae, Choi, "3D medial axis point approximation using nearest neighbors and the normal
// field", 2012): a ball that is too large, touching at the place, is made smaller until it passes through the point of
// the surface that was nearest to its centre, again and again until none is inside. Where the triangle that it touches
// last faces the other way, the two are the sides of a wall.
//
// What is not a wall by this definition:
//  - Beside an edge of the body the ball touches the triangles around that edge, which do not face the other way.
//  - In a round bar or a ball the largest ball touches all around, so that the triangles' noise decides which of them
//    is named, and often none that faces the other way.
//  - At a vertex or an edge of the triangulation that is convex, however flat, no ball touches from inside. So ask
//    inside triangles, with the triangle's own normal.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/triangle_tree.hpp"

#include <cstdint>
#include <optional>

namespace scan2fea {

struct WallOptions {
  // The diameter of the ball to begin with, model units, above 0: what is thicker is not a wall.
  double deepest = 0;
  // Cosine of the angle between the normals of both sides, at most. -0.5: they face one another within 60 degrees.
  double opposing = -0.5;
};

struct Wall {
  // From the place to where the ball touches the other side, model units: the ball's diameter where the sides are
  // parallel, and sin(a / 2) of it where their normals are at an angle a (0.87 of it at the least, by default).
  double thickness;
  Vec3 across;             // where that is
  std::uint32_t opposite;  // the triangle there
};

// Nothing where there is no wall. `outward` is the unit normal at `place`; `tree` holds all of the mesh's triangles.
// The surface should be closed and turned outwards; where it is not, less is found. Right to a thousandth, since the
// ball may be cut by a millionth of its radius. Two to eight searches of the tree, the fewer the less deep; O(log n)
// each but about the middle of a ball, from where all triangles are equally far. Any number of threads.
std::optional<Wall> find_wall(const SurfaceMesh& mesh, const TriangleTree& tree, const Vec3& place, const Vec3& outward,
                              const WallOptions& options);

}  // namespace scan2fea
