// Solids of one surface that overlap or touch along faces, made one, by CGAL's corefinement.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"
#include "quality/self_intersections.hpp"

#include <span>

namespace scan2fea {

// Replaces each set of outward-oriented shells that intersect one another by the surface of their union. Sets in which
// a shell intersects itself, or whose union would not be manifold, stay as they are; so do all other shells. `pairs`
// are the surface's intersecting pairs. The faces of a union come last, in an order of their own; its vertices are
// those of the shells bit by bit, and new ones where the shells cross, rounded (which can make them cross again by a
// rounding error). Returns whether anything changed. Precondition: closed, manifold, oriented.
bool unite_shells(SurfaceMesh& mesh, std::span<const FacePair> pairs, RepairResult& result);

}  // namespace scan2fea
