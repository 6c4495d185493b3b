// Gives a closed surface exactly the volume it should have.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/vertex_constraint.hpp"

#include <cstddef>
#include <vector>

namespace scan2fea {

// By more than this a triangle is turned out of a plane: 32-bit coordinates turn one by less, a curved surface by far
// more.
inline constexpr double plane_rad = 1e-4;

// Per vertex, whether all triangles around it lie in one plane.
std::vector<bool> vertices_in_planes(const SurfaceMesh& mesh);

// Plane faces stay where they are if what is curved has this part of a component's area or more.
inline constexpr double least_moving_area = 0.05;

struct VolumeShift {
  double largest_displacement = 0;  // of a vertex, model units
  std::size_t components = 0;       // that were shifted one by one; 1 where all were shifted together
};

// Moves every free vertex of `mesh` by the same distance along its normal, per connected component, so that each
// component encloses the volume of the component of `like` that it stands for (the one whose vertices are nearest), to
// the rounding of the coordinates. Where the components cannot be paired one to one, all are shifted by one distance to
// the volume of the whole. Vertices of plane faces stay where they are if what is curved has a twentieth of the
// component's area or more; `outwards` tells of those that are held to planes (its move when all planes move outwards by
// one, else zero; or empty), which with too little else move by that.
// Throws NotMeshable for surfaces that are not closed and oriented, where the shift would exceed a mean edge length
// (the two then do not stand for the same body), and where no shift reaches the volume. Near linear in the meshes. Not
// guaranteed: that the shift makes no triangles cross; it is far below an edge length for a fitted surface, but see
// mend_surface.hpp.
VolumeShift preserve_volume(SurfaceMesh& mesh, const SurfaceMesh& like, const VertexConstraints& constraints = {},
                            const std::vector<Vec3>& outwards = {});

// Gives each component of the surface the volume of `like` (see preserve_volume), by moving only vertices that then
// meet nothing. False, and the mesh as it was, where that fails. Precondition: no self-intersections; it has none
// afterwards either.
bool preserve_volume_clear(SurfaceMesh& mesh, const SurfaceMesh& like, VertexConstraints constraints = {},
                           const std::vector<Vec3>& outwards = {});

}  // namespace scan2fea
