// Curved sides of bodies that touch, fitted to their scans: the outside, and the pieces of surface between bodies.
#pragma once

#include "preproc/bodies/body_complex.hpp"
#include "preproc/joined_surface.hpp"
#include "preproc/mesh/progress.hpp"
#include "preproc/surface/curved/fit_curves.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace scan2fea {

struct CurvedBodies {
  CurvedSurface surface;         // of all triangles of the complex, as they are numbered there
  std::vector<Vec3> directions;  // as of FittedCurves
  std::size_t straight = 0;      // triangles that stay as they were, since curved ones would meet others
};

// `made`: all surfaces, straight, the volume of each body restored; `outside`: the curved sides of what was simplified
// as one, whose vertices were `outside_before`; `sheets`: the pieces between bodies. Nodes on lines where bodies meet
// are those of the outside; within, they lie on the scan's lines. Each body keeps the volume that it has in `made`, as
// far as nodes can move that no other body has settled: those between it and others first. No two triangles meet that
// the straight ones kept apart, each taken as four plane ones. Throws Cancelled and OutOfTime.
CurvedBodies fit_bodies(const BodyComplex& made, const FittedCurves& outside, const std::vector<Vec3>& outside_before,
                        std::span<const MadeSheet> sheets, const Progress& progress = {});

// Moves nodes along their directions until each body has again the volume that it has in `made`.
[[nodiscard]] bool keep_volumes_of_bodies(const BodyComplex& made, const std::vector<Vec3>& directions,
                                          CurvedSurface& surface);

}  // namespace scan2fea
