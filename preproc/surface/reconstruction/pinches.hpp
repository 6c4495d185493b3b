// Edges and corners in which the inside of a cut meets itself: what is a thin neck or a narrow gap there is decided, by
// what costs the cut least.
#pragma once

#include "preproc/surface/reconstruction/delaunay.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

// Of a minimum cut.
struct CutCosts {
  std::vector<double> gain;                  // of having a cell inside instead of outside
  std::vector<std::array<double, 4>> price;  // of having a cell inside and its neighbour, across a side, outside
};

// Edges about which the cells change sides more than twice: of the surface between, four triangles or more have them.
std::size_t count_pinched_edges(const DelaunayCells& cells, const std::vector<bool>& is_inside);

// At each such edge one of the runs of cells on one side changes over: the one for which the cut costs least among
// those after which fewer edges are pinched. Not guaranteed: that none is left. O(cells), and 10 us an edge.
void open_pinches(const DelaunayCells& cells, const CutCosts& costs, std::vector<bool>& is_inside);

}  // namespace scan2fea
