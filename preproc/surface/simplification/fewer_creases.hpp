// A scan with fewer creases, where a surface of it has failed.
#pragma once

#include "preproc/surface/simplification/surface_candidate.hpp"

#include <vector>

namespace scan2fea {

// The scan of `failed` without the short creases near the places where it failed.
PreparedScanPointer without_short_creases(const Candidate& failed);

// The same without all creases that come within so many mean edges of `places`: of long ones, the pieces there.
PreparedScanPointer without_pieces(const Candidate& failed, const std::vector<Vec3>& places, double reach);

}  // namespace scan2fea
