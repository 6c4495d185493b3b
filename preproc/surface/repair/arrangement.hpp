// A surface cut along the lines in which it crosses itself.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "quality/self_intersections.hpp"

#include <cstdint>
#include <optional>
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
// common edges and in common vertices only. What lies within the tolerance of a vertex is that vertex, of an edge on
// it, and faces that lie within it of one plane lie in that plane: there each has the outline of what they have in
// common as edges, but may be cut differently within it. Of several vertices in one place the first stays. Crossings
// are found exactly, as in Zhou, Grinspun, Zorin, Jacobson, "Mesh Arrangements for Solid Geometry" (2016); the places
// of new vertices are rounded in the end. Nothing where what was moved by the tolerance would cross anew.
//
// `pairs` are intersecting pairs of the surface, or pairs in one plane; a face of no area is left alone. Precondition:
// the tolerance is positive. About 0.1 ms a pair, more where many cross one face.
std::optional<Arrangement> arrange(const SurfaceMesh& mesh, std::span<const FacePair> pairs, double tolerance,
                                   const Progress& progress = {});

// Whether the corners of one of two faces lie within a tolerance of the plane of the other.
bool lie_in_one_plane(const SurfaceMesh& mesh, std::uint32_t face, std::uint32_t other, double tolerance);

}  // namespace scan2fea
