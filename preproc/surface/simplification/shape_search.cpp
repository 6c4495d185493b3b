#include "preproc/surface/simplification/shape_search.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/simplification/shape_check.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

// Around bad places edge lengths may grow this many times as fast as elsewhere: at the surface's own gradation a few
// short edges would drag those of a whole neighbourhood along.
constexpr double gradation_around_bad = 2;

// Each renewal shortens by a quarter at the least, so eleven could shorten 23 times; most_triangles and patience end
// the search long before.
constexpr int most_renewals = 11;

// Renewals without a gain, one after the other, after which it is given up. Another lattice may turn out better by
// chance, which is worth waiting for only where it costs little.
constexpr std::size_t many_triangles = 5000, very_many_triangles = 20000;
constexpr int most_in_vain = 3, most_in_vain_of_many = 1, most_in_vain_of_very_many = 0;

// Two lattices of nearly the same sizes differ by about this; a smaller gain is chance.
constexpr double worth_it_deg = 0.5;

// Above many_triangles only surfaces below this are renewed: where time matters, the optimisation of the tetrahedra
// copes with the rest.
constexpr double good_of_many_deg = 17;

// Where the shorter lengths ask for fewer triangles more than this, the other edges grow to make up for them.
constexpr double room_for_places = 1.05;

// With more bad triangles than this the size as a whole is wrong, not places.
constexpr double share_of_many = 0.1;

// Wanted with fewer triangles than this, a part without its edges stands for nothing any more: edges go before angles.
constexpr double few_triangles_of_part = 1000;

// No more triangles than these times the wanted ones. A small part may have 8,000, which cost nothing, but not more
// than forty times: somebody who asks for 20 does not want 8,000.
constexpr double most_triangles = 3, few_triangles = 8000, most_triangles_of_small = 40;

// Corners of the part stay about as they are; what else is bad decides then.
bool is_better(const ShapeDefects& defects, const ShapeDefects& other) {
  if (std::abs(defects.sharpest() - other.sharpest()) > worth_it_deg) return defects.sharpest() > other.sharpest();
  return defects.least_angle_deg > other.least_angle_deg;
}

int patience(std::size_t triangles) {
  return triangles < many_triangles        ? most_in_vain
         : triangles < very_many_triangles ? most_in_vain_of_many
                                           : most_in_vain_of_very_many;
}

// A surface of the search, and what counts when it is held against another.
struct ShapedSurface {
  Candidate candidate;
  ShapeDefects defects;
  bool lost_creases = false;   // all that it was to keep
  bool is_other_part = false;  // a small part without its edges is another part

  bool gave_way() const { return !candidate.fallback_reason.empty(); }
  bool is_better_than(const ShapedSurface& other) const {
    return is_other_part == other.is_other_part ? is_better(defects, other.defects) : other.is_other_part;
  }
  bool gains_over(const ShapedSurface& other) const {
    return (other.is_other_part && !is_other_part) || defects.sharpest() > other.defects.sharpest() + worth_it_deg;
  }
  // What cannot be kept but by smaller triangles everywhere.
  bool has_many_bad() const {
    return static_cast<double>(defects.bad.size()) > share_of_many * static_cast<double>(candidate.faces());
  }
};

ShapedSurface try_sizing(const PreparedScanPointer& scan, const SizingOptions& sizing, double wanted_triangles,
                         const SimplifyOptions& options, const Progress& progress) {
  ShapedSurface made{.candidate = make_surface(scan, sizing, options, options.effort, progress), .defects = {}};
  if (made.candidate.method == SimplifyMethod::lattice) lower_worst(made.candidate, options.effort, progress);
  open_wedges(made.candidate, options);
  made.defects = find_shape_defects(made.candidate);
  made.lost_creases = scan->has_creases() && made.candidate.feature_edges() == 0;
  made.is_other_part = made.lost_creases && wanted_triangles < few_triangles_of_part;
  return made;
}

bool is_good_enough(const ShapedSurface& made) {
  if (made.defects.empty() && !made.is_other_part) return true;
  return made.candidate.faces() >= many_triangles && !made.gave_way() && made.defects.sharpest() >= good_of_many_deg;
}

// The creases to ask for after this surface: none where they would ask for smaller triangles everywhere though few are
// bad without them, and no corners too narrow for a triangle.
PreparedScanPointer creases_after(const ShapedSurface& made, const PreparedScanPointer& scan) {
  if (made.lost_creases && !made.gave_way() && !made.has_many_bad() && !made.is_other_part)
    return with_creases(scan, {});
  return with_creases(scan, without_narrow_corners(scan->mesh, scan->creases(), made.defects.sharp_corners));
}

// Around what is bad, or everywhere where that is the surface as a whole.
void shorten_after(const ShapedSurface& made, const SurfaceMesh& scan, double gradation, std::vector<double>& length) {
  if (made.gave_way() || (made.lost_creases && made.has_many_bad()) || made.is_other_part)
    for (double& l : length) l *= least_shortening;
  else
    shorten_around(made.defects.bad, scan, length);
  limit_gradation(scan, gradation, length);
}

}  // namespace

Candidate make_shaped_surface(PreparedScanPointer scan, const SizingOptions& sizing, const SimplifyOptions& options,
                              const Progress& progress) {
  const double most =
      std::max(most_triangles * sizing.triangles, std::min(few_triangles, most_triangles_of_small * sizing.triangles));
  ShapedSurface best = try_sizing(scan, sizing, sizing.triangles, options, progress);
  if (options.method != SimplifyMethod::lattice) return std::move(best.candidate);
  ShapedSurface latest = best;
  std::vector<double> length;
  SizingOptions renewed = sizing;
  for (int renewal = 0, in_vain = 0; renewal < most_renewals && !is_good_enough(latest); ++renewal) {
    if (in_vain > patience(latest.candidate.faces())) break;
    if (length.empty()) length = latest.candidate.scan->wanted_lengths(sizing);
    scan = creases_after(latest, scan);
    shorten_after(latest, scan->mesh, gradation_around_bad * sizing.gradation, length);
    ask_for_lengths(scan->mesh, length, renewed);
    // A few places cost the others little.
    if (renewed.triangles < room_for_places * sizing.triangles) renewed.triangles = sizing.triangles;
    if (renewed.triangles > most) break;
    try {
      latest = try_sizing(scan, renewed, sizing.triangles, options, progress);
    } catch (const NotMeshable&) {
      break;
    }
    in_vain = latest.gains_over(best) ? 0 : in_vain + 1;
    if (latest.is_better_than(best)) best = latest;
  }
  return std::move(best.candidate);
}

}  // namespace scan2fea
