// Bodies that a scan holds twice: a part scanned, registered or exported a second time, a little beside the first.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"
#include "quality/self_intersections.hpp"

#include <span>

namespace scan2fea {

// Drops closed shells that cross an earlier one and are nowhere farther from it than a thousandth of its diagonal, nor
// it from them, both facing the same way. Their union would be the part with steps along all of its edges, lower than
// half of the deviation that a result has by default. The walls of a thin part are not taken for one another: they face
// opposite ways, and where they do not cross nothing is dropped.
// `pairs`: faces that cross. Returns whether any were dropped.
// O(n log n) for shells whose boxes agree, else nothing.
bool drop_repeated_shells(SurfaceMesh& mesh, std::span<const FacePair> pairs, RepairResult& result);

}  // namespace scan2fea
