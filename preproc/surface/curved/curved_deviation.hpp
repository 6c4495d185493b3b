// How far curved triangles are from a scan, and which of them are farther than they may be.
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

// Bounds per curved triangle and per triangle of the scan, by pieces that are plane, and finer ones of the few faces of
// which the first do not tell: right to a hundredth of the distance that is to be kept where they exceed it, else to a
// tenth.
DeviationBound bound_curved_deviation(const CurvedSurface& surface, const KeptDeviation& kept);

// Those of `faces` that are farther from the scan; where these are all faces, also those that are nearest to what of
// the scan is too far from the surface. Sorted. By the same bounds.
std::vector<std::uint32_t> faces_beyond(const CurvedSurface& surface, const KeptDeviation& kept,
                                        const std::vector<std::uint32_t>& faces);

}  // namespace scan2fea
