// A surface cut along the lines in which it crosses itself.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/self_intersections.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace scan2fea {

struct Arrangement {
  SurfaceMesh mesh;                    // the input's vertices, then those at crossings
  std::vector<std::uint32_t> face_of;  // of each triangle, the face of the input that it is a part of
  // Faces of the input that have an area in common, both ways round, ascending.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping;
};

// Cuts the faces of the pairs (and faces beside them at whose edges others end) so that those of the pairs meet along
// common edges and in common vertices only. Where faces lie in one plane and overlap, each has the outline of what they
// have in common as edges, but may be cut differently within it. Vertices in the same place that the pairs' faces use
// become the first of them. Exact, as in Zhou, Grinspun, Zorin, Jacobson, "Mesh Arrangements for Solid Geometry"
// (2016), but for the places of new vertices, which are rounded in the end: very close ones may coincide, and faces
// whose crossing is as short as that rounding may cross anew.
//
// `pairs` are intersecting pairs of the surface; pairs of a face of no area with itself are left alone. About 0.1 ms a
// pair, more where many cross one face.
Arrangement arrange(const SurfaceMesh& mesh, std::span<const FacePair> pairs);

}  // namespace scan2fea
