// A gap between two surfaces that may have been meant to touch.
#pragma once

#include "preproc/bodies/facing_surface.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace scan2fea {

struct Gap {
  double height;
  Vec3 place;
  std::uint32_t triangle, foot;  // of the surface, and of the other one
};

// The widest of the places of the listed triangles that face `other` across more than `tolerance` and at most `reach`,
// in pieces of such triangles that touch it nowhere.
std::optional<Gap> find_gap(const SurfaceMesh& mesh, std::span<const std::uint32_t> triangles, const FacingSurface& own,
                            const FacingSurface& other, double tolerance, double reach);

}  // namespace scan2fea
