#include "preproc/tetrahedra_search.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/surface/sizing/shorter_edges.hpp"
#include "preproc/volume/boundary_relocation.hpp"
#include "preproc/volume/poor_elements.hpp"
#include "quality/tetrahedron_measures.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace scan2fea {
namespace {

// Elements below good_deg are poor: on surfaces without thin places the optimisation reaches 24.7 to 31 degrees
// (tests/benchmark/README.md). Where the surface itself allows less, of_bound of that will do, but below least_deg the
// surface is itself to be mended if it can be. To move vertices of the surface along it costs so little that it is done
// below moved_deg.
constexpr double good_deg = 24, moved_deg = 28, of_bound = 0.9, least_deg = 20;
// A share of all elements; with more the surface is too coarse as a whole.
constexpr double many_poor = 0.1;
// A first surface of more takes too long to make again, and to fill again, which costs by the elements: six a triangle,
// but a hundred where a few places have triangles far smaller than the body.
constexpr std::size_t most_triangles = 50000, most_elements = 6 * most_triangles;
// No more triangles than these, over the first surface's or absolute.
constexpr double most_growth = 2, most_of_small = 12000;
// Another lattice may turn out better by chance, which is waited for longer where it costs little.
constexpr std::size_t few_triangles = 5000;
// Of what lacks to moved_deg: vertices of poor elements that gained so much by moving are moved again.
constexpr double worth_again = 0.25;

double smallest_dihedral(const FilledSurface& made) {
  return measure_tetrahedra(made.filled.mesh).min_dihedral_deg;
}

bool is_good(double angle, double allowed, double wanted) {
  return angle >= std::min(wanted, std::max(of_bound * allowed, least_deg));
}

bool is_good(double angle, const FilledSurface& made, double wanted_deg) {
  return is_good(angle, made.filled.bound.min_dihedral_deg, wanted_deg);
}

std::vector<PoorElement> poor_elements(const FilledSurface& made) {
  return find_poor_elements(made.filled.mesh, made.surface, good_deg);
}

// Where many are poor, all the surface must be far finer, which only a small one may be.
bool can_be_mended(const std::vector<PoorElement>& poor, const FilledSurface& made) {
  const bool small = static_cast<double>(made.surface.triangles.size()) < most_of_small / most_growth;
  return !poor.empty() && (small || static_cast<double>(poor.size()) <=
                                        many_poor * static_cast<double>(made.filled.mesh.tetrahedra.size()));
}

std::vector<ShorterEdges> shorter_around(const std::vector<PoorElement>& poor) {
  std::vector<ShorterEdges> places;
  for (const PoorElement& element : poor)
    places.push_back(shorter_edges(element.centre, element.longest_edge, element.min_dihedral_deg, good_deg));
  return places;
}

}  // namespace

bool is_good_dihedral(double angle_deg, double allowed_deg) {
  return is_good(angle_deg, allowed_deg, good_deg);
}

bool worth_renewing(const SimplifyOptions& simplification, const FilledSurface& made) {
  if (simplification.method != SimplifyMethod::lattice || simplification.effort == Effort::low) return false;
  if (simplification.effort != Effort::high &&
      (made.surface.triangles.size() > most_triangles || made.filled.mesh.tetrahedra.size() > most_elements))
    return false;
  return !is_good(smallest_dihedral(made), made, moved_deg);
}

RenewalResult renew_where_poor(Simplification& search, const SimplifyOptions& simplification,
                               const TetrahedralizeOptions& tetrahedralization, FilledSurface made,
                               const Progress& progress) {
  RenewalResult result;
  TetrahedralizeOptions limited = tetrahedralization;
  if (simplification.effort != Effort::high)
    limited.most_tetrahedra = std::max(most_elements, made.filled.mesh.tetrahedra.size());
  result.min_dihedral_before_deg = result.min_dihedral_after_deg = smallest_dihedral(made);
  const int most_in_vain = made.surface.triangles.size() < few_triangles ? 4 : 2;
  const int most_rounds = simplification.effort == Effort::high ? 8 : 4;
  const double most = std::max(most_growth * static_cast<double>(made.surface.triangles.size()), most_of_small);
  FilledSurface latest = made;
  result.made = std::move(made);
  int in_vain = 0;     // surfaces since one that is better
  int ways_tried = 0;  // since a surface that is better, or another one
  while (result.rounds < most_rounds && !is_good(result.min_dihedral_after_deg, result.made, moved_deg) &&
         progress.may_improve()) {
    const bool is_poor = !is_good(result.min_dihedral_after_deg, result.made, good_deg);
    const std::vector<PoorElement> poor = poor_elements(latest);
    // Along the surface first, which costs no distance from the scan.
    const int ways = is_poor && search.way_off() > 0 ? 2 : 1;
    std::optional<SimplifyResult> simplified;
    for (; !simplified && ways_tried < ways; ++ways_tried)
      simplified = search.run_moved(relocate_boundary(latest.filled.mesh, latest.surface, search.held(),
                                                      ways_tried == 0 ? 0 : search.way_off(), moved_deg),
                                    latest.surface);
    if (!simplified) {
      if (!is_poor || !can_be_mended(poor, latest) || in_vain == most_in_vain) break;
      simplified = search.run_again(shorter_around(poor), most, latest.surface, progress.for_improvement());
      if (!simplified) break;
      ++result.rounds;
      ++in_vain;
      ways_tried = 0;
    }
    try {
      latest.simplified = *simplified;
      latest.filled = tetrahedralize(latest.surface, limited, progress.for_improvement());
    } catch (const MeshingFailed&) {
      break;
    } catch (const NotMeshable&) {
      break;
    }
    const double angle = smallest_dihedral(latest);
    progress.explain("around " + std::to_string(poor.size()) + " poor tetrahedra " +
                     (ways_tried == 0 ? "edges were made shorter" : "vertices of the surface were moved") +
                     ": smallest dihedral angle " + error_text(angle, 3) + " deg, of the best so far " +
                     error_text(result.min_dihedral_after_deg, 3) + " deg");
    const bool is_mended = is_poor && is_good(angle, latest, good_deg) && angle > result.min_dihedral_after_deg;
    if (!is_mended && angle < result.min_dihedral_after_deg + worth_it_deg) continue;
    if (is_poor && angle - result.min_dihedral_after_deg > worth_again * (moved_deg - result.min_dihedral_after_deg))
      ways_tried = 0;
    in_vain = 0;
    result.min_dihedral_after_deg = angle;
    result.made = latest;
  }
  return result;
}

}  // namespace scan2fea
