// What a repair changed: counts, and a list of places for the report.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <string_view>
#include <vector>

namespace scan2fea {

enum class RepairKind {
  WeldedVertex,      // joined to another, which closed a border; size: the distance moved
  SplitEdge,         // at a vertex that lay beside it (a T-junction), which closed a border; size: the gap
  UnusedVertex,      // no face used it; size 0
  DegenerateFace,    // of no area: removed, collapsed or flipped away; size: its longest edge
  DuplicateFace,     // the same three vertices as another face; size: its area
  InnerWall,         // a sheet that met the rest only in non-manifold edges; size: its area
  SplitVertex,       // parted into one vertex per fan of faces; size 0
  NonManifoldFaces,  // faces about an edge that no splitting could mend, cut out and filled; size: their area
  TurnedFaces,       // orientation reversed to agree with its neighbours or to point outwards; size: area turned
  DroppedSpeck,      // a body that is not to stay (RepairOptions::bodies); size: its area
  FilledCavity,      // a cavity too small to matter, left out; size: its area
  DroppedFragment,   // an open or flat component that holds no volume (RepairOptions::fragment_of_area); size: its area
  DroppedInside,     // what lay inside the solid after parts were joined or cut; size: its area
  RepeatedShell,     // a body that crosses another and lies along all of it (repeated_shells.hpp); size: its area
  ThickenedSheet,    // an open sheet made a solid (RepairOptions::thickness); size: the thickness
  ClosedHole,        // size: the diagonal of its border's bounding box
  Wrapped,           // all of it, by a surface around it; size: the distance between them
  PartedTouch,       // a vertex, or a shell as it is, moved off what it touched; size: the distance moved
  UnitedShell,       // a solid that overlapped others, made one with them; size: its area
  SmoothedFold,      // a vertex smoothed because its faces crossed others; size: the distance moved
  Intersection,      // a group of faces that crossed others, cut out and filled; size: the area cut out
};

std::string_view name(RepairKind kind);

struct RepairChange {
  RepairKind kind;
  Vec3 place;         // a point of what was changed, or its centre
  double size;        // model units; what it measures is said beside each kind
  double area = 0;    // of what is_lost or is_made_up
  double volume = 0;  // of a closed body that was dropped
};

// Whether such a change leaves out something that the scan shows: walls, bodies, doubled sheets.
bool is_lost(RepairKind kind);

// Whether such a change puts faces where the scan shows none, or other ones: over holes and where it was cut.
bool is_made_up(RepairKind kind);

struct RepairResult {
  std::vector<RepairChange> changes;   // in the order in which they were made
  std::size_t intersecting_pairs = 0;  // pairs of faces that crossed before any were removed
  std::size_t faces_removed = 0;       // patches that did not last included, as in faces_added
  std::size_t faces_added = 0;
  std::size_t bodies = 0;  // closed shells that face outwards, at the end

  bool unchanged() const { return changes.empty(); }
  std::size_t count(RepairKind kind) const;
  double total_size(RepairKind kind) const;  // the sum of the sizes: area for the kinds that measure an area
};

}  // namespace scan2fea
