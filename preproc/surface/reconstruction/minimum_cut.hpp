// Which tetrahedra are inside: what several surfaces of their triangles say, made one closed surface by a minimum cut.
#pragma once

#include "preproc/surface/reconstruction/cell_sides.hpp"
#include "preproc/surface/reconstruction/delaunay.hpp"
#include "preproc/surface/reconstruction/seen_cells.hpp"

#include <vector>

namespace scan2fea {

// A surface of the tetrahedra's triangles, open or not, and how it winds about their centres, 0 to 1, one way or the
// other: an advancing front may turn itself inside out where points are few.
struct WoundSurface {
  std::vector<Triangle> triangles;
  std::vector<double> winding;  // one a cell; 0 outside of the convex hull
};
WoundSurface wind(const std::vector<Vec3>& points, const DelaunayCells& cells, std::vector<Triangle> triangles);

struct CutSurface {
  std::vector<Triangle> triangles;
  std::size_t pinched_edges = 0;  // at which the inside met itself before they were opened (pinches.hpp)
};

// The boundary of those tetrahedra that are inside: closed, oriented outwards and free of crossings, mostly without
// edges of four triangles. Inside is where the surfaces wind about a tetrahedron's centre. A triangle that all surfaces
// have costs nothing; any other costs its area, as much of it as lacks in votes, and more where it is long for the
// `spacing` at its corners; a voted one that is left out costs its area, too, and a tetrahedron on the wrong side as
// much as one of its triangles. What all that costs is the least there is. Then once more with what the surfaces have
// of this cut, all of it outwards now; pieces that meet in an edge alone are made one there. Sources of the idea:
// Labatut, Pons, Keriven, "Robust and efficient surface reconstruction from range data", 2009; winding_number.hpp; the
// maximum flow is of Boykov and Kolmogorov, 2004, from Boost. Empty where nothing is inside. About 10 us a tetrahedron;
// parallel in part, the same for any number of threads. `known`: of each tetrahedron, or none. `seen`: what points
// themselves say (seen_cells.hpp), beside the surfaces; or nothing.
CutSurface cut_surface(const std::vector<Vec3>& points, const std::vector<double>& spacing, const DelaunayCells& cells,
                       const std::vector<const WoundSurface*>& surfaces, const std::vector<CellSide>& known = {},
                       const SeenCells& seen = {});

// The same with pieces of `parted`, such a cut, joined across gaps that are no longer than `longest` spacings, where
// one of the surfaces has them in one component: a front that turns itself inside out on a thin leg has sheets across
// it, at which the cut parts the leg.
CutSurface join_pieces(const std::vector<Vec3>& points, const std::vector<double>& spacing, const DelaunayCells& cells,
                       const std::vector<const WoundSurface*>& surfaces, const std::vector<Triangle>& parted,
                       double longest, const SeenCells& seen = {});

}  // namespace scan2fea
