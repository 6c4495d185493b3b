// The rims of one surface drawn on another one that it lies on.
#pragma once

#include "preproc/bodies/facing_surface.hpp"
#include "preproc/bodies/split_surface.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <span>

namespace scan2fea {

// Cuts `surface` along the creases of `other`, an edge of its listed triangles each, where one of a crease's two sides
// lies on `surface` and the other one does not. What is nearer than `tolerance` to a vertex or an edge of the surface
// runs along it instead. `facing` is of the surface before any cut, `step` the length of the shortest contact that is
// looked for along a crease.
void imprint_rims(SplitSurface& surface, const FacingSurface& facing, const SurfaceMesh& other,
                  std::span<const std::uint32_t> triangles, double tolerance, double step);

}  // namespace scan2fea
