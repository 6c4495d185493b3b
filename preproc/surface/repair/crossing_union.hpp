// Solids that overlap or touch along faces, and parts of one solid that pass through each other, made one.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"
#include "quality/self_intersections.hpp"

#include <span>

namespace scan2fea {

enum class Crossings {
  between_shells,  // of one shell with another
  within_shells,   // of a shell with itself
};

// Replaces shells that cross by the surface of all that they enclose: what has material on one side (a winding number
// of one or more) and none on the other. A shell may cross itself with both sides the right way round, as a tube does
// that passes through itself; where it is inside out beyond a crossing (a winding number below 0), as in the folds of a
// noisy scan, there is nothing to unite, and that crossing stays. So does the tangle of a shell with itself that has
// more than eight pairs a face.
//
// Solids that touch along faces, within four steps of 32-bit floats, become one wherever they lie in space, as long as
// any of their faces meet at all. A union that would lose volume of a solid is not made. What it leaves out of
// the faces is logged, with its area and its place.
//
// `pairs` are the surface's intersecting pairs. Faces that nothing crosses stay where they are or go; new ones come
// last. Vertices stay bit by bit; new ones, where shells cross, are rounded, which can make their faces cross again by
// a rounding error. Returns whether anything changed. Precondition: closed, manifold, oriented; afterwards the surface
// may have edges of four faces (where solids touch along an edge), and cracks as wide as rounding (where it left
// slivers out of account).
//
// Costs the arrangement (see arrangement.hpp), two or three more where the first does not come out closed, and
// O(n log n).
bool unite_crossings(SurfaceMesh& mesh, std::span<const FacePair> pairs, Crossings which, RepairResult& result,
                     const Progress& progress = {});

}  // namespace scan2fea
