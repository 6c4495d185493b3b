// The chain of several bodies that may touch: repair each, join them, simplify, tetrahedralize each, second order.
#pragma once

#include "preproc/bodies/body_complex.hpp"
#include "preproc/pipeline.hpp"

#include <vector>

namespace scan2fea {

// The outside of all bodies is simplified as one surface, along with the lines at which bodies meet there; then the
// pieces of surface between bodies, whose borders are these lines, in which the volume of each body is restored; then
// each body is filled by itself, up to the same triangles. The volume mesh has a set of elements for each body, by its
// name; faces between bodies A and B, whose nodes both share, are the set of faces INTERFACE_A_B, in the order in which
// the bodies were given. Options are as of run_pipeline but for enrichment and voxels, which there are none of, for
// renewal, which makes small meshes again with smaller triangles, and that a volume is always made. Figures compare
// with all scans as given. Throws what run_pipeline and join_bodies throw, and WrongUsage for fewer than two bodies.
PipelineResult run_pipeline_of_bodies(std::vector<Body> bodies, const JoinOptions& joining = {},
                                      const PipelineOptions& options = {}, const Progress& progress = {},
                                      const StageListener& listener = {});

}  // namespace scan2fea
