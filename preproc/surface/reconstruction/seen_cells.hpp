// What normals and scanners tell of the tetrahedra: a point has the material behind it, and nothing stands between it
// and the scanner that saw it. Source: Labatut, Pons, Keriven, "Robust and efficient surface reconstruction from range
// data", 2009.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/reconstruction/delaunay.hpp"
#include "preproc/surface/reconstruction/point_views.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace scan2fea {

// In areas, as a minimum cut weighs triangles.
struct SeenCells {
  std::vector<double> inside;                  // of each cell: what speaks for inside, or, negative, for outside
  std::vector<std::array<double, 4>> crossed;  // by views that leave it through the facet opposite to each corner
};

// What a point says weighs `weight` times its area, which its spacing tells. Cells about it are inside where they are
// behind it, outside where before, as squarely as they are so; and the view from it to the scanner leaves no cell that
// is inside. What is within three times the noise of the point is no obstacle. O(points) for normals; about 0.1 us for
// each cell that a view crosses.
SeenCells see_cells(const std::vector<Vec3>& points, const std::vector<double>& spacing, const DelaunayCells& cells,
                    const PointViews& views, double weight);

}  // namespace scan2fea
