// A solid of an open sheet: what a scan of a panel, a shell or a cup shows of one side only.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"

namespace scan2fea {

// To which side of the sheet material is put: half to each, all where its normals point, or all on the other side.
enum class ThickenTo { both, front, back };

struct Thickness {
  double thickness = 0;  // model units, above 0
  ThickenTo side = ThickenTo::both;
  bool operator==(const Thickness&) const = default;
};

// Replaces each open shell by a closed one of the given thickness: two copies of it, offset along its normals, and a
// strip of quadrilaterals along each border that joins them. Each vertex is moved so that the planes of its faces move
// by the offset as nearly as one place can have it (least squares), so that a bend keeps its thickness; by three times
// the offset at the most. Where the sheet bends more sharply than its thickness allows, or meets itself, the solid
// crosses itself, and is mended as any surface. Precondition: manifold. O(n).
void thicken_sheets(SurfaceMesh& mesh, const Thickness& thickness, RepairResult& result);

}  // namespace scan2fea
