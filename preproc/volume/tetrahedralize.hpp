// Fills a closed surface with tetrahedra.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/tet_mesh.hpp"
#include "preproc/volume/interior_points.hpp"
#include "preproc/volume/optimise_tetrahedra.hpp"
#include "preproc/volume/run_tetgen.hpp"
#include "preproc/volume/surface_bound.hpp"

#include <optional>
#include <vector>

namespace scan2fea {

// Who places the nodes inside.
enum class InteriorPoints {
  automatic,  // the lattice, unless most of the body is thinner than an edge is long
  lattice,    // see lattice_points: the better shapes wherever there is room
  tetgen,     // TetGen's refinement by radius-edge ratio: the better shapes in thin walls
};

struct TetrahedralizeOptions {
  InteriorPoints interior = InteriorPoints::automatic;
  // Edge length inside; the lattice's.
  InteriorSize interior_size;
  // Largest volume of a tetrahedron that the mesher aims at, model units cubed, above 0. The optimisation may join a
  // few into larger ones. None: as the sizes above have it.
  std::optional<double> max_volume;
  // TetGen's radius-edge ratio, 1.1 to 2, for TetGen's own points: how fast tetrahedra grow away from small triangles.
  // Below 1.2 TetGen may not terminate; above 2 the shape suffers.
  double grading = 1.2;
  // TetGen may put nodes on the surface where that helps. Off: the triangles are those of the validated surface.
  bool split_boundary = false;
  // None: the tetrahedra as TetGen made them.
  std::optional<OptimiseOptions> optimise = OptimiseOptions{};
  TetgenLimits tetgen;
  // Where more are estimated NotMeshable is thrown before they are made.
  std::optional<std::size_t> most_tetrahedra;
};

struct TetrahedralizeResult {
  TetMesh mesh;
  // Where the boundary was allowed to be split: the surface triangle that each boundary face lies on. Else empty:
  // boundary face i is triangle i.
  std::vector<std::uint32_t> boundary_parent;
  InteriorPoints interior = InteriorPoints::lattice;  // who placed them: never automatic
  std::size_t estimated_tetrahedra = 0;               // as told before the mesher ran; see estimate_tetrahedra.hpp
  SurfaceBound bound;                                 // of the surface given
  OptimiseResult optimised;
};

// Source: Si, "TetGen, a Delaunay-based quality tetrahedral mesh generator", ACM TOMS 41 (2015).
// The surface is closed, manifold, free of self-intersections and faces outwards; shells within shells that face
// inwards are cavities and stay empty; disjoint bodies are all filled. Its triangles become `mesh.boundary` in their
// order (unless split), its vertices the first nodes. `progress` announces the estimated count before the mesher
// runs. TetGen must be done by the end of `progress`; the optimisation ends
// with a valid mesh when there is no time for it. Else the same mesh for the same input. Throws NotMeshable where the
// surface is open, not manifold or inside out, MeshingFailed (see TetgenLimits and fill_regions), OutOfTime, Cancelled.
// About 15 s for a million tetrahedra. Not guaranteed: any shape of the tetrahedra but that they are positive; see
// SurfaceBound for what the surface allows.
TetrahedralizeResult tetrahedralize(const SurfaceMesh& surface, const TetrahedralizeOptions& options = {},
                                    const Progress& progress = {});

}  // namespace scan2fea
