#include "preproc/surface/simplification/shape_search.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/surface/features/feature_selection.hpp"
#include "preproc/surface/simplification/shape_check.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

constexpr double gradation_around_bad = 2;  // over the surface's
constexpr int most_renewals = 11;
// In a row, without a gain that is worth it: of few triangles, of many, of very many.
constexpr int most_in_vain = 3, most_in_vain_of_many = 1, most_in_vain_of_very_many = 0;
constexpr double worth_it_deg = 0.5;
constexpr std::size_t many_triangles = 5000, very_many_triangles = 20000;
constexpr double good_of_many_deg = 17;   // what the tetrahedra's optimisation copes with, where time matters
constexpr double room_for_places = 1.05;  // over the triangles wanted
// Of the triangles, that are bad.
constexpr double share_of_many = 0.1;
// Over those wanted; and what a small part may have in any case.
constexpr double few_triangles_of_part = 1000;
constexpr double most_triangles = 3, few_triangles = 8000, most_triangles_of_small = 40;
// Corners of the part stay about as they are; what else is bad decides then.
bool is_better(const ShapeDefects& defects, const ShapeDefects& other) {
  if (std::abs(defects.sharpest() - other.sharpest()) > worth_it_deg) return defects.sharpest() > other.sharpest();
  return defects.least_angle_deg > other.least_angle_deg;
}

void shorten_around(const std::vector<BadPlace>& bad, const SurfaceMesh& scan, std::vector<double>& length) {
  for (std::size_t v = 0; v < length.size(); ++v) {
    double factor = 1;
    for (const BadPlace& place : bad)
      if ((scan.vertices[v] - place.centre).squaredNorm() < place.reach * place.reach)
        factor = std::min(factor, place.shortening);
    length[v] *= factor;
  }
}

int patience(std::size_t triangles) {
  return triangles < many_triangles        ? most_in_vain
         : triangles < very_many_triangles ? most_in_vain_of_many
                                           : most_in_vain_of_very_many;
}

}  // namespace

Candidate make_shaped_surface(PreparedScan& scan, const SizingOptions& sizing, const SimplifyOptions& options,
                              SimplifyResult& result, const Progress& progress) {
  const double most =
      std::max(most_triangles * sizing.triangles, std::min(few_triangles, most_triangles_of_small * sizing.triangles));
  std::vector<FeatureEdge> creases = scan.features().sharp;
  SizingOptions renewed = sizing;
  std::vector<double> length;
  Candidate best;
  ShapeDefects best_defects;
  bool best_is_other_part = false;
  SimplifyResult best_result;
  for (int renewal = 0, in_vain = 0;; ++renewal) {
    SimplifyResult made = result;
    Candidate candidate;
    try {
      candidate = make_surface(scan, renewed, options, options.effort, made, progress);
    } catch (const NotMeshable&) {
      if (renewal == 0) throw;
      break;
    }
    if (made.method == SimplifyMethod::lattice) lower_worst(candidate, scan, options.effort, made, progress);
    open_wedges(candidate, scan, options);
    const ShapeDefects defects = find_shape_defects(candidate);
    const std::size_t triangles = candidate.mesh.triangles.size();
    const bool lattice_failed = !made.fallback_reason.empty();
    const bool lost_creases = !creases.empty() && made.feature_edges_kept == 0;
    // A small part without its edges is another part.
    const bool is_other_part = lost_creases && sizing.triangles < few_triangles_of_part;
    const bool is_best =
        renewal == 0 || (best_is_other_part == is_other_part ? is_better(defects, best_defects) : best_is_other_part);
    const bool gained = renewal == 0 || (best_is_other_part && !is_other_part) ||
                        defects.sharpest() > best_defects.sharpest() + worth_it_deg;
    in_vain = gained ? 0 : in_vain + 1;
    if (is_best) {
      best_is_other_part = is_other_part;
      best = std::move(candidate);
      best_defects = defects;
      best_result = std::move(made);
    }
    if (options.method != SimplifyMethod::lattice || (defects.empty() && !is_other_part) || renewal == most_renewals)
      break;
    if (triangles >= many_triangles && !lattice_failed && defects.sharpest() >= good_of_many_deg) break;
    if (in_vain > patience(triangles)) break;

    if (length.empty()) length = scan.wanted_lengths(sizing);
    // What cannot be kept but by smaller triangles everywhere is not asked for again where few are bad without it.
    const bool many_bad = static_cast<double>(defects.bad.size()) > share_of_many * static_cast<double>(triangles);
    if (lost_creases && !lattice_failed && !many_bad && !is_other_part) creases.clear();
    creases = without_narrow_corners(scan.mesh, creases, defects.sharp_corners);
    scan.keep_creases(creases);
    if (lattice_failed || (lost_creases && many_bad) || is_other_part)
      for (double& l : length) l *= least_shortening;
    else
      shorten_around(defects.bad, scan.mesh, length);
    limit_gradation(scan.mesh, gradation_around_bad * sizing.gradation, length);
    ask_for_lengths(scan.mesh, length, renewed);
    // A few places cost the others little.
    if (renewed.triangles < room_for_places * sizing.triangles) renewed.triangles = sizing.triangles;
    if (renewed.triangles > most) break;
  }
  result = std::move(best_result);
  result.faces_after = best.mesh.triangles.size();
  return best;
}

}  // namespace scan2fea
