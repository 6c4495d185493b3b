// From a scan that is ready to the mesh: simplified, filled, made better, curved.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/stair_steps.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/pipeline.hpp"
#include "preproc/stage_log.hpp"
#include "preproc/symmetry/half_scan.hpp"
#include "preproc/tetrahedra_search.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace scan2fea {

// A scan that is one half of another.
struct Half {
  const HalfScan& scan;
  const MirrorFrame& frame;
};

// Which triangles of the surface that was made are to have layers; lengths, and the surface, as the scan has them.
using LayersOf =
    std::function<LayeredTriangles(const SurfaceMesh& surface, const std::vector<FeatureEdge>& line_edges)>;

// Those stages of run_pipeline, each with its record in the log; what they leave out for want of time goes into
// `result`. Places in messages are the scan's, or those of the whole of which it is a half. `half`: null where it is
// none. `layers_of`: empty where there are no layers.
FilledSurface mesh_of_scan(const SurfaceMesh& scan, const std::optional<StairSteps>& stairs,
                           const PipelineOptions& options, const Half* half, const LayersOf& layers_of,
                           const Progress& progress, PipelineResult& result, StageLog& log);

// Where a mesh is no use to any solver there is none; but who asks for the paper's collapse gets its needles, too, and
// is told.
std::vector<WeakPlace> checked_for_solvers(const SurfaceMesh& surface, const TetMesh* volume_mesh,
                                           const SurfaceMesh& scan, const PipelineOptions& options,
                                           std::size_t flat_tetrahedra = 0);

}  // namespace scan2fea
