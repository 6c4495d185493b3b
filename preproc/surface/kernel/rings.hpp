// Rings around sets of faces, as marks per face or per vertex.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// A set of a surface's faces: a mark per face, not 0 for those in the set.
using FaceMarks = std::vector<char>;

// Adds the faces that share a vertex with the set, again and again.
void grow(const SurfaceMesh& mesh, FaceMarks& marks, int rings);

// Adds the vertices of all faces that have one in the set, again and again. `vertices`: a mask over the mesh's
// vertices.
void grow_vertices(const SurfaceMesh& mesh, std::vector<bool>& vertices, int rings);

// Vertices of `faces` and of everything within `rings` rings around them, as a mask over the mesh's vertices.
std::vector<bool> vertices_around(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces, int rings);

}  // namespace scan2fea
