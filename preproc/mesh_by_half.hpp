// The mesh of a symmetric part from that of its half.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/stair_steps.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/pipeline.hpp"
#include "preproc/stage_log.hpp"
#include "preproc/tetrahedra_search.hpp"

#include <optional>

namespace scan2fea {

// As mesh_of_scan, of the half on one side of the scan's mirror plane, and its mirror image. Precondition:
// `options.symmetry`. Throws WrongUsage for options that have no halves and open scans, NotMeshable where the scan has
// no mirror plane within its noise (mirror_limits), and what mesh_of_scan throws.
FilledSurface mesh_by_half(const SurfaceMesh& scan, const std::optional<StairSteps>& stairs, PipelineOptions options,
                           const Progress& progress, PipelineResult& result, StageLog& log);

}  // namespace scan2fea
