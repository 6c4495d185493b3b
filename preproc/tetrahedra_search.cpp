#include "preproc/tetrahedra_search.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/volume/poor_elements.hpp"
#include "quality/tetrahedron_measures.hpp"

#include <algorithm>
#include <utility>

namespace scan2fea {
namespace {

constexpr double good_deg = 24;
constexpr double of_bound = 0.9;
// A surface that allows less is itself to be mended if it can be.
constexpr double least_deg = 20;
constexpr double many_poor = 0.1;  // of the elements
constexpr std::size_t most_triangles = 50000;
constexpr double most_growth = 2, most_of_small = 12000;  // triangles, over the first surface's or absolute
constexpr double worth_it_deg = 1;
// Around a poor element: over its longest edge, and of the surface's edges there, by how poor it is.
constexpr double reach = 1.5, most_shortening = 0.5, least_shortening = 0.75;

double smallest_dihedral(const FilledSurface& made) {
  return measure_tetrahedra(made.filled.mesh).min_dihedral_deg;
}

bool is_good(double angle, const FilledSurface& made) {
  return angle >= std::min(good_deg, std::max(of_bound * made.filled.bound.min_dihedral_deg, least_deg));
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

void shorten_around(const std::vector<PoorElement>& poor, SizeLimits& limits) {
  for (const PoorElement& element : poor) {
    const double shortening = std::clamp(element.min_dihedral_deg / good_deg, most_shortening, least_shortening);
    limits.balls.push_back({{element.centre, reach * element.longest_edge}, shortening * element.surface_edge});
  }
}

}  // namespace

bool worth_renewing(const SimplifyOptions& simplification, const TetrahedralizeOptions& tetrahedralization,
                    const FilledSurface& made) {
  if (simplification.method != SimplifyMethod::lattice || simplification.effort == Effort::low ||
      tetrahedralization.time_limit)
    return false;
  if (simplification.effort != Effort::high && made.surface.triangles.size() > most_triangles) return false;
  return !is_good(smallest_dihedral(made), made) && can_be_mended(poor_elements(made), made);
}

RenewalResult renew_where_poor(const SurfaceMesh& scan, const SimplifyOptions& simplification,
                               const TetrahedralizeOptions& tetrahedralization, FilledSurface& made,
                               const Progress& progress) {
  RenewalResult result;
  result.min_dihedral_before_deg = result.min_dihedral_after_deg = smallest_dihedral(made);
  const int most_rounds = simplification.effort == Effort::high ? 6 : 3;
  const double most = std::max(most_growth * static_cast<double>(made.surface.triangles.size()), most_of_small);
  SimplifyOptions finer = simplification;
  FilledSurface latest = made;
  while (result.rounds < most_rounds && !is_good(result.min_dihedral_after_deg, made)) {
    const std::vector<PoorElement> poor = poor_elements(latest);
    if (!can_be_mended(poor, latest)) break;
    shorten_around(poor, finer.limits);
    ++result.rounds;
    try {
      latest.simplified = simplify(scan, latest.surface, finer, progress);
      if (static_cast<double>(latest.surface.triangles.size()) > most) break;
      latest.filled = tetrahedralize(latest.surface, tetrahedralization, progress);
    } catch (const NotMeshable&) {
      break;
    } catch (const MeshingFailed&) {
      break;
    }
    const double angle = smallest_dihedral(latest);
    if (angle < result.min_dihedral_after_deg + worth_it_deg) continue;
    result.min_dihedral_after_deg = angle;
    made = latest;
  }
  return result;
}

}  // namespace scan2fea
