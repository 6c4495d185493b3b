// Vertices of the surface that go along the scan to where the tetrahedra behind them are better.
#pragma once

#include "preproc/surface/features/planes_of_scan.hpp"
#include "preproc/tetrahedra_search.hpp"

namespace scan2fea {

struct SlideResult {
  double most = 0;          // what was allowed, model units
  double largest_move = 0;  // of a vertex
  std::size_t moved = 0;    // vertices
  double min_dihedral_before_deg = 0, min_dihedral_after_deg = 0;
  double max_dihedral_before_deg = 0, max_dihedral_after_deg = 0;
  bool is_taken = false;  // else the mesh is as it was, since another one would be no better
};

// `made` came of a simplification, `planes` of the same scan. Nodes inside and vertices of the surface are moved by
// turns, the latter along the scan, its lines and planes (ways_on_scan.hpp), no farther than `most` each: so the
// surface stays within `most` of what it was, both ways. Its volume is that of the scan again, and nothing meets that
// did not before. Where a deviation that was asked for would be lost, vertices stay, five times at most. About as long
// as the optimisation that went before, for each.
SlideResult slide_boundary(const PlanesOfScan& planes, double most, FilledSurface& made, const Progress& progress);

}  // namespace scan2fea
