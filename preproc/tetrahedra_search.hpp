// Poor elements mended. What limits tetrahedra whose boundary stays is the surface: thin folds and walls that only show
// when it is filled. There its vertices are moved, or its edges made shorter, and it is filled anew.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/simplification/simplify.hpp"
#include "preproc/volume/tetrahedralize.hpp"

namespace scan2fea {

struct FilledSurface {
  SurfaceMesh surface;
  SimplifyResult simplified;
  TetrahedralizeResult filled;
  std::size_t flat_tetrahedra = 0;  // the first of its mesh, which are flat as they are to be: layers
};

// Whether elements came out with a dihedral angle below 28 degrees or 0.9 of what the surface allows (but at least 20),
// and it is affordable to do something about them: not with Effort::low, the `collapse` method or, unless the effort is
// high, above 50,000 triangles.
bool worth_renewing(const SimplifyOptions& simplification, const FilledSurface& made);

// Whether this will do as the smallest dihedral angle: 24 degrees, or 0.9 of what the surface allows, but at least 20.
bool is_good_dihedral(double angle_deg, double allowed_deg);

// A smaller gain is not worth other triangles than the ones that were told.
inline constexpr double worth_it_deg = 1;

struct RenewalResult {
  FilledSurface made;  // the best, which may be the first
  int rounds = 0;      // surfaces made
  double min_dihedral_before_deg = 0;
  double min_dihedral_after_deg = 0;  // never less
  bool gained() const { return min_dihedral_after_deg > min_dihedral_before_deg; }
};

// `made` came of `search` with these options. Vertices of the surface go along it to where the elements around them are
// best, then, while some are below 24 degrees, off it; then edges there are made shorter, by another surface (but not
// where of 6,000 triangles or more a tenth of all elements is poor). Another mesh takes the first one's place where its
// smallest dihedral angle is larger by a degree, until none is poor or the search gives no other surface. Each costs a
// filling; four other surfaces at most, and with Effort::high eight, with at most twice as many triangles, or 12,000.
// When there is no time for improvements any more, the best so far is given; else the same result for any number of
// threads. Throws Cancelled. Not guaranteed: a gain.
RenewalResult renew_where_poor(Simplification& search, const SimplifyOptions& simplification,
                               const TetrahedralizeOptions& tetrahedralization, FilledSurface made,
                               const Progress& progress = {});

}  // namespace scan2fea
