// Curved triangles that are farther from a scan than they may be.
#pragma once

#include "preproc/surface/curved/curved_surface.hpp"
#include "quality/deviation_bound.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// A curved surface is to stay this near to the scan, both ways; see bound_deviation.
struct KeptDeviation {
  const DeviationReference& scan;
  double distance;
};

// Those of `faces` that are farther from the scan; where these are all faces, also those that are nearest to what of
// the scan is too far from the surface. Not those that are straight already. Sorted. By pieces that are plane, and
// finer ones of the few faces of which the first do not tell; right to a hundredth of the distance.
std::vector<std::uint32_t> faces_beyond(const CurvedSurface& surface, const KeptDeviation& kept,
                                        const std::vector<std::uint32_t>& faces, const std::vector<bool>& is_straight);

}  // namespace scan2fea
