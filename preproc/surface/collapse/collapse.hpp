// Simplification by edge contraction, as [1] has it: candidates are predicted by a local decimation cost, the cheapest
// edge is contracted, and the kept vertex is placed by the entropy of its star in the tangent plane and lifted. No
// vertex moves afterwards. Source: [1], section 3 (bending energy as predictor, entropy as corrector; README.md lists
// the sources). Quadrics: Garland and Heckbert, "Surface simplification using quadric error metrics", 1997. Link
// condition: Dey, Edelsbrunner et al., 1999.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/collapse/collapse_options.hpp"

namespace scan2fea {

// Precondition: `mesh` is an oriented manifold (NotMeshable otherwise); it may have borders, which are contracted only
// along themselves, to midpoints, where they turn by less than 30 degrees. Topology never changes: components, genus,
// borders; closed in, closed out. Vertices that no face uses are dropped.
// Throws WrongUsage for options out of range. On any throw `mesh` is as it was.
// With keep_volume the volume of each closed component is kept to rounding.
// Deterministic, one thread, O(n log n); about 100 bytes a face of the input, 260 with closest_point, 210 with
// keep_clear.
// Not guaranteed: a bound on the deviation; absence of self-intersections, unless keep_clear is set.
CollapseResult collapse(SurfaceMesh& mesh, const CollapseOptions& options, const Progress& progress = {});

}  // namespace scan2fea
