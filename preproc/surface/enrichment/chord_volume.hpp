// What triangles cut off a round body that their corners lie on, and how to have it back.
#pragma once

#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <vector>

namespace scan2fea {

// Places for the vertices marked `free` from which the flat triangles enclose what the curved surface through the
// vertices does; the others stay. The surface over a triangle is a parabola along each edge by the normals at its ends,
// which are the means of the triangles' about them; the volume between it and the triangle goes to its free corners,
// each of which moves along its normal by what it has over a third of the area around it. A vertex moves by less than
// the height of those parabolas, outwards where the surface is convex. None on `creases` (per vertex, or none at all)
// counts or moves: there the surface bends between triangles; nor does one on a border move. O(faces).
std::vector<Vec3> with_chord_volume(const HalfedgeMesh& mesh, const std::vector<bool>& free,
                                    const std::vector<bool>& creases);

}  // namespace scan2fea
