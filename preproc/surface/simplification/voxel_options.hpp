// What a scan that is made of voxels is simplified with.
#pragma once

#include "preproc/mesh/stair_steps.hpp"
#include "preproc/surface/simplification/simplify_options.hpp"

#include <optional>
#include <string>

namespace scan2fea {

// Nearer to voxels than their size there are stairs instead of a shape: a deviation that is only aimed at is raised to
// it, and the stairs are not taken for creases unless these are given. The size in `options` must be in model units.
// Returns what that changed, in words; empty, and `options` as they were, where there are no voxels.
std::string adapt_to_voxels(const std::optional<StairSteps>& stairs, SimplifyOptions& options);

}  // namespace scan2fea
