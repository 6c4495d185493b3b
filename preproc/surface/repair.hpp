// Makes of a freshly read scan the surface that every later stage presumes: closed, edge- and vertex-manifold, oriented
// outwards, free of self-intersections, of one or several components, and enclosing a volume.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair_result.hpp"

#include <optional>

namespace scan2fea {

struct RepairOptions {
  // Holes whose border's bounding box has a diagonal up to this fraction of its component's are closed; a larger one is
  // an error, since a patch over it would be invented rather than interpolated. Unset: all are closed. [0, 1].
  // 0.35: the base of a statue that a scanner could not see is about that, the mouth of a vase or an open sheet above.
  std::optional<double> largest_hole_of_diagonal = 0.35;

  // Components whose bounding box has a diagonal below this fraction of the largest component's are dropped: the dust
  // and stray returns of a scan. [0, 1]; 0 keeps all. 0.01: below it a component has no effect on stiffness, and its
  // triangles would be smaller than the simplified surface's.
  double speck_of_diagonal = 0.01;

  // Components that enclose no volume (flat, or with a hole that is too large to close) are dropped if their area is
  // below this fraction of the whole; above it they are an error. [0, 1]. 0.01: a scan's stray sheets are below it.
  double fragment_of_area = 0.01;
};

// In this order, each step leaving alone what is sound:
//  1. unused vertices, faces with a repeated vertex, and duplicate faces are dropped. Of faces on the same three
//  vertices
//     one stays, unless the patch of them is a double wall between two closed parts: then none.
//  2. Borders that coincide exactly are welded.
//  3. Inner walls and flaps, sheets that hang on non-manifold edges and whose removal leaves every edge with an even
//     number of faces, are dropped, smallest first.
//  4. Faces are paired at every edge (at non-manifold ones across the material between them), oriented consistently,
//  and
//     vertices are split so that each has one fan of faces.
//  5. Specks are dropped (see the options), holes closed: triangulated with the least worst dihedral angles and area,
//     refined to the density of the border, faired tangent-continuously, or, where the border is a sharp edge, as a
//     membrane (flat if the border is).
//  6. Faces of no area are removed by collapsing and flipping edges.
//  7. Shells are oriented by nesting: the outermost outwards, cavities inwards, parts within cavities outwards.
//  8. Touching vertices are moved apart by a hundredth of their edges, and faces that still intersect are cut out with
//  a
//     ring of neighbours and filled, in rounds of growing rings. Pieces that this leaves inside the solid are dropped.
//
// Vertices that no change needs keep their coordinates bit by bit and their order; so do faces. A sound input is
// returned as it was.
//
// Throws InvalidInput for indices out of range, coordinates that are not finite, or no faces; NotMeshable, naming
// place, size and option, where a hole is too large to close, the surface encloses no volume (below 1e-6 of area^1.5),
// or intersections remain. O(n log n) for a sound input; each hole of b border edges costs up to O(b^2) or, in bad
// cases, O(b^3). Not guaranteed: that crossing parts are united as a solid modeller would (they are parted by a narrow
// gap), nor that what lies over a hole resembles what the scanner did not see.
RepairResult repair(SurfaceMesh& mesh, const RepairOptions& options = {}, const Progress& progress = {});

}  // namespace scan2fea
