#include "preproc/renewal.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/volume/poor_elements.hpp"
#include "quality/tetrahedron_measures.hpp"

#include <algorithm>
#include <cmath>
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
// Triangles of all rounds together, so that small surfaces have many and large ones few.
constexpr double most_work = 60000, most_work_of_high_effort = 300000;
constexpr int fewest_rounds = 2, most_rounds_of_small = 6;
constexpr int most_in_vain = 3;  // in a row
// Around a poor element: over its longest edge, and of the surface's edges there, by how poor it is.
constexpr double reach = 1.5, growth_of_reach = 1.4, most_shortening = 0.5, least_shortening = 0.75;

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
  const double most = small ? 1 : many_poor;
  return !poor.empty() &&
         static_cast<double>(poor.size()) <= most * static_cast<double>(made.filled.mesh.tetrahedra.size());
}

int rounds_for(std::size_t triangles, Effort effort) {
  const double budget = effort == Effort::high ? most_work_of_high_effort : most_work;
  return std::clamp(static_cast<int>(budget / static_cast<double>(triangles)), fewest_rounds, most_rounds_of_small);
}

// Further around for each attempt that gained nothing, so that it differs.
void shorten_around(const std::vector<PoorElement>& poor, int in_vain, SizeLimits& limits) {
  const double radius = reach * std::pow(growth_of_reach, in_vain);
  for (const PoorElement& element : poor) {
    const double shortening = std::clamp(element.min_dihedral_deg / good_deg, most_shortening, least_shortening);
    limits.balls.push_back({{element.centre, radius * element.longest_edge}, shortening * element.surface_edge});
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
  const int most_rounds = rounds_for(made.surface.triangles.size(), simplification.effort);
  const double most = std::max(most_growth * static_cast<double>(made.surface.triangles.size()), most_of_small);
  SimplifyOptions finer = simplification;
  SizeLimits limits_of_made = simplification.limits;
  for (int in_vain = 0;
       result.rounds < most_rounds && in_vain < most_in_vain && !is_good(result.min_dihedral_after_deg, made);) {
    const std::vector<PoorElement> poor = poor_elements(made);
    if (!can_be_mended(poor, made)) break;
    finer.limits = limits_of_made;
    shorten_around(poor, in_vain, finer.limits);
    ++result.rounds;
    ++in_vain;
    FilledSurface renewed;
    try {
      renewed.simplified = simplify(scan, renewed.surface, finer, progress);
      if (static_cast<double>(renewed.surface.triangles.size()) > most) continue;
      renewed.filled = tetrahedralize(renewed.surface, tetrahedralization, progress);
    } catch (const NotMeshable&) {
      continue;
    } catch (const MeshingFailed&) {
      continue;
    }
    const double angle = smallest_dihedral(renewed);
    if (angle < result.min_dihedral_after_deg + worth_it_deg) continue;
    result.min_dihedral_after_deg = angle;
    result.gained = true;
    made = std::move(renewed);
    limits_of_made = finer.limits;
    in_vain = 0;
  }
  return result;
}

}  // namespace scan2fea
