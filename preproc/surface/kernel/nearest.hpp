// For points near a mesh, the mesh's vertices to start a search from, and its faces.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// Per point the vertex of `among` that is nearest, where normals that disagree by more than 90 degrees count like a
// distance of `spacing` (so that the two sides of a thin wall are told apart). Only vertices that a triangle uses are
// considered; the mesh must have one. k-d tree: O((n + m) log m).
std::vector<std::uint32_t> nearest_vertices(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                                            const SurfaceMesh& among, double spacing);

// The same where only vertices of a point's own patch will do: patches as numbers, per point and per vertex. A point
// whose patch has no vertex gets the nearest of all.
std::vector<std::uint32_t> nearest_vertices_of_patch(const std::vector<Vec3>& points, const std::vector<Vec3>& normals,
                                                     const std::vector<std::uint32_t>& patch_of_point,
                                                     const SurfaceMesh& among,
                                                     const std::vector<std::uint32_t>& patch_of_vertex, double spacing);

// Per point the nearest face of `mesh`, whatever its orientation; the mesh must have one. Points that are neighbours in
// the list should be near each other: that makes the searches fast. O((n + m) log m), parallel; the same for any number
// of threads.
std::vector<std::uint32_t> nearest_faces(const std::vector<Vec3>& points, const SurfaceMesh& mesh);

}  // namespace scan2fea
