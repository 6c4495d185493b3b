// Gaps between two surfaces that may have been meant to touch.
#pragma once

#include "preproc/bodies/facing_surface.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

struct Gap {
  double narrowest, widest;  // of what is in reach
  Vec3 middle;               // of the way across, at the narrowest
  Vec3 place;                // of the surface, at the widest
  std::uint32_t triangle;    // of the first surface, at the widest
};

// One of two surfaces that may face one another: these triangles of a mesh.
struct GapSide {
  const SurfaceMesh& mesh;
  std::span<const std::uint32_t> triangles;
  const FacingSurface& facing;
};

// Of either surface, the pieces that face the other one across at most `reach` and touch it nowhere; by the middles and
// corners of triangles, of both surfaces. `triangle` is of the first surface in all of them.
std::vector<Gap> find_gaps_between(const GapSide& first, const GapSide& second, double tolerance, double reach);

}  // namespace scan2fea
