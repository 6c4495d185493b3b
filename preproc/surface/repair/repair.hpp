// Makes of a freshly read scan the surface that every later stage presumes: closed (unless its holes are to stay),
// edge- and vertex-manifold, oriented outwards, free of self-intersections, of one or several components, and enclosing
// a volume.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/kept_bodies.hpp"
#include "preproc/surface/repair/repair_result.hpp"
#include "preproc/surface/repair/thicken.hpp"

#include <optional>

namespace scan2fea {

// What becomes of the holes of a scan: a volume needs a closed surface; shells and parts of parts may be open.
enum class Holes { close, keep };

// How far a repair may go.
enum class RepairLevel {
  off,     // changes nothing: what is not sound is an error
  gentle,  // joins, splits, pairs, turns and drops, and moves no vertex farther than a gap that it closes
  full,    // also fills holes, and parts, unites or cuts out what crosses
  wrap,    // also, where that fails, replaces the scan by a surface around it (wrap.hpp)
};

struct RepairOptions {
  RepairLevel level = RepairLevel::full;

  Holes holes = Holes::close;

  // Holes whose border's bounding box has a diagonal up to this fraction of its component's are closed; a larger one is
  // an error, since a patch over it would be invented rather than interpolated. Unset: all are closed. [0, 1].
  // 0.35: the base of a statue that a scanner could not see is about that, the mouth of a vase or an open sheet above.
  std::optional<double> largest_hole_of_diagonal = 0.35;

  // Makes solids of open shells instead of closing their holes: a panel or a cup that was scanned from one side.
  std::optional<Thickness> thickness = std::nullopt;

  // Which bodies stay; the others are dropped before anything is done to them.
  KeptBodies bodies = BodiesOfNote{};

  // Components that enclose no volume (flat, or with a hole that is too large to close) are dropped if their area is
  // below this fraction of the whole; above it they are an error. [0, 1]. 0.01: a scan's stray sheets are below it.
  double fragment_of_area = 0.01;

  bool operator==(const RepairOptions&) const = default;
};

// The steps, in this order; each leaves alone what is sound:
//
// 1. Soup. Unused vertices, faces with a repeated vertex, and duplicate faces are dropped; of faces on the same three
// vertices one stays, but none of a double wall between two closed parts. Borders that coincide exactly are welded.
// Inner walls and flaps (sheets without which each of their edges has an even number of faces) go, smallest first.
//
// 2. Manifold. Faces are paired at every edge, at non-manifold ones across the material between them, and oriented
// consistently; vertices are split so that each has one fan of faces. Debris is dropped.
//
// 3. Closed. Holes are triangulated with the least worst dihedral angles and area, refined to the density of the
// border, and faired tangent-continuously, or as a membrane (flat if the border is) where the border is a sharp edge.
// Faces of no area are mended by collapsing and flipping edges.
//
// Instead, with a thickness, open shells become solids (thicken.hpp).
//
// 4. Outwards. Shells are oriented by nesting: the outermost outwards, cavities inwards, parts within cavities
// outwards.
//
// 5. Free of intersections. A solid that lies along all of another that it crosses is dropped (repeated_shells.hpp);
// solids that overlap are united, touching vertices drawn apart by a hundredth of their edges, folds smoothed within an
// edge's length; what still crosses is cut out with a ring of neighbours and filled, in rounds of growing rings. Pieces
// that this leaves inside a solid are dropped.
//
// With `Holes::keep` the third step mends faces only, open components count as fragments no more, need enclose nothing,
// and keep the orientation that most of their faces had unless they are so nearly closed that outwards means something;
// and of a surface with holes solids that overlap are cut like all else. Where what is cut reaches a border, the border
// draws back.
//
// Vertices that no change needs keep their coordinates bit by bit and their order; so do faces, but for those of united
// solids, which come last. A sound input is returned as it was. The same input gives the same output for any number of
// threads.
//
// Throws InvalidInput: indices out of range, coordinates that are not finite, no faces. NotMeshable, naming the place,
// the value and the limit: a hole too large to close; no volume (below 1e-6 of area^1.5) where nothing is open;
// intersections that remain, or that only cutting out more than a third of the surface would remove. The mesh is then
// in an unspecified state.
//
// A sound surface costs a check of its connectivity and one search for intersections, O(n log n). A hole of b border
// edges costs about O(b^2).
//
// Not guaranteed: that what lies over a hole resembles what the scanner did not see, nor that a part cut where it
// passed through itself stays one piece.
RepairResult repair(SurfaceMesh& mesh, const RepairOptions& options = {}, const Progress& progress = {});

}  // namespace scan2fea
