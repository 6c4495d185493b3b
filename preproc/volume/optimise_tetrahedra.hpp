// Local optimisation of a tetrahedral mesh whose boundary stays as it is.
#pragma once

#include "preproc/mesh/effort.hpp"
#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/tet_mesh.hpp"
#include "preproc/volume/boundary_ways.hpp"
#include "preproc/volume/patch_relocation.hpp"

#include <optional>

namespace scan2fea {

struct OptimiseOptions {
  // Elements below this goal_quality are worked on, 0.5 to 2. 1.4 asks for dihedral angles of 32 to 130 degrees and a
  // scaled Jacobian of 0.39, where the surface allows them. On the adaptive Horse, 1.5 takes 60 % more of the
  // optimisation's time for 1.5 degrees more, 1.35 a sixth less for 1 degree less; above, insertion costs elements and
  // mean.
  double threshold = 1.4;
  // Rounds of topology with insertion and max-min relocation, 0 to 4. The third adds half a degree at most; but where
  // dihedral angles below 24 or above 136 degrees are left, there are up to 8 while they gain.
  int insertion_rounds = 2;
  // At last all nodes around a poor element move at once, since one after the other they get no farther: half a degree
  // to two more, for some 10 ms an element.
  std::optional<PatchOptions> patches = {};
};

OptimiseOptions optimise_options(Effort effort);

struct OptimiseResult {
  double worst_before = 0, worst_after = 0;  // goal_quality
  std::size_t edge_removals = 0, face_removals = 0, removals = 0, insertions = 0, relocations = 0, patches = 0;
  bool stopped_by_time = false;
};

// Passes: topology, smoothing, topology, smoothing, topology, smoothing, max-min relocation; then, for each round,
// topology with insertion and, where elements stay poor, removal of vertices, and max-min relocation; at last, where
// asked for, relocation of patches around the worst elements that are left. Every move lifts the least quality of what
// it touches, so the mesh's least quality never falls (unless patches count the Jacobian otherwise). At most a fortieth
// as many vertices are inserted as there are elements, so that these grow by a sixth at most, and 40 on small meshes.
// The mesh is of first order with positive tetrahedra; `boundary` and its nodes stay, in their order; nodes from `kept`
// on that lose all their elements vanish. When there is no time for improvements any more, the mesh is given as it then
// stands, valid and better than it was; else deterministic. Throws Cancelled. Some 3 us per element on one thread.
OptimiseResult optimise_tetrahedra(TetMesh& mesh, std::size_t kept, const OptimiseOptions& options = {},
                                   const Progress& progress = {});

// The same where nodes of the boundary may go, too, as far as their ways lead.
OptimiseResult optimise_tetrahedra(TetMesh& mesh, std::size_t kept, const OptimiseOptions& options,
                                   const BoundaryWays& ways, const Progress& progress = {});

}  // namespace scan2fea
