// Which of the bodies that a scan shows are the part, and which are debris: dust, stray returns, neighbours.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"

#include <cstddef>
#include <variant>

namespace scan2fea {

// All but those that are small beside the largest both in size, below a tenth of its bounding box's diagonal, and in
// what they hold, below a thousandth of its volume (of what balls of their areas hold, where one of the two is open). A
// body that is small in one of them alone (a long thin rod, a small solid beside a large thin frame) may well carry
// load.
struct BodiesOfNote {
  bool operator==(const BodiesOfNote&) const = default;
};

struct AllBodies {
  bool operator==(const AllBodies&) const = default;
};

// The largest by area.
struct LargestBodies {
  std::size_t count = 1;
  bool operator==(const LargestBodies&) const = default;
};

// Those whose bounding box has a diagonal of this length or more, in model units.
struct BodiesAbove {
  double diagonal = 0;
  bool operator==(const BodiesAbove&) const = default;
};

using KeptBodies = std::variant<BodiesOfNote, AllBodies, LargestBodies, BodiesAbove>;

// Drops the other shells and logs each. Cavities, closed shells that face inwards within the box of a body, go with
// that body; with `BodiesOfNote` those below a hundredth of the largest diagonal are filled: their triangles would be
// smaller than those of the surface. Precondition: manifold. O(n log n), and O(s) for each cavity of s shells.
void drop_debris(SurfaceMesh& mesh, const KeptBodies& kept, RepairResult& result);

}  // namespace scan2fea
