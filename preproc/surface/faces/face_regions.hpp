// Connected pieces of a surface that lie on one shape each.
#pragma once

#include "preproc/surface/faces/triangle_labels.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

struct FaceRegions {
  std::vector<std::uint32_t> of_triangle;
  std::vector<std::uint32_t> label;  // per region: a primitive, or no_primitive
};

// `mesh` and `cut`: the surface and the same cut along its creases, triangle by triangle; `labels`: one a triangle.
// Pieces that are narrower than a row of triangles, or have a few triangles only, go to their neighbours, triangle by
// triangle to the one that describes it best and lies across no crease if there is such a one; but not those that are
// exactly plane and have creases around. Pieces of one shape that touch are one. O(n log n).
FaceRegions find_regions(const SurfaceMesh& mesh, const SurfaceMesh& cut, const TriangleLabels& shapes,
                         std::vector<std::uint32_t> labels);

}  // namespace scan2fea
