#include "preproc/surface/simplification/surface_trial.hpp"

#include "preproc/mesh/error_text.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

// With more bad triangles than this the size as a whole is wrong, not places.
constexpr double share_of_many = 0.1;

// With more places at which a lattice failed, over the triangles: they need more than a patch has.
constexpr double few_failed_places = 0.01;

// Two lattices of nearly the same sizes differ by about this; a smaller gain is chance.
constexpr double worth_it_deg = 0.5, worth_it_of_deviation = 0.9;

// Above, an angle that is small in a few places costs less than another surface.
constexpr std::size_t most_for_shape = 50000;

}  // namespace

bool SurfaceTrial::has_many_bad() const {
  return static_cast<double>(shape.bad.size()) > share_of_many * static_cast<double>(candidate.faces());
}

std::vector<ShorterEdges> SurfaceTrial::failed_places() const {
  const auto faces = static_cast<double>(candidate.faces());
  if (static_cast<double>(candidate.failed_at.size()) > few_failed_places * faces) return {};
  const double edge = equilateral_edge(surface_area(candidate.mesh), faces);
  std::vector<ShorterEdges> places;
  for (const Vec3& p : candidate.failed_at) places.push_back(shorter_edges(p, edge, least_shortening, 1));
  return places;
}

bool TrialOrder::holds(const SurfaceTrial& made) const {
  return !made.failed() && (!deviation || made.candidate.largest_deviation <= deviation->distance);
}

bool TrialOrder::is_shapely(const SurfaceTrial& made) const {
  return !deviation || made.mean_edge_ratio <= worst_mean_edge_ratio || takes_any_shape;
}

bool TrialOrder::is_accepted(const SurfaceTrial& made) const {
  if (!holds(made) || !is_shapely(made) || made.is_other_part) return false;
  // Of very many another lattice costs far more than the few places that it may mend are worth.
  return made.shape.empty() || (!made.gave_way() && !made.has_many_bad() && made.candidate.faces() >= most_for_shape);
}

// Corners of the part stay about as they are; what else is bad decides then.
bool TrialOrder::is_better(const SurfaceTrial& made, const SurfaceTrial& other) const {
  if (made.failed() != other.failed()) return other.failed();
  if (made.is_other_part != other.is_other_part) return other.is_other_part;
  if (is_aim() && std::min(made.shape.sharpest(), other.shape.sharpest()) < usable_deg &&
      std::abs(made.shape.sharpest() - other.shape.sharpest()) > worth_it_deg)
    return made.shape.sharpest() > other.shape.sharpest();
  if (holds(made) != holds(other)) return holds(made);
  if (!holds(made) && made.gave_way() != other.gave_way()) return other.gave_way();
  if (!holds(made)) return made.candidate.largest_deviation < other.candidate.largest_deviation;
  if (is_shapely(made) != is_shapely(other)) return is_shapely(made);
  if (std::abs(made.shape.sharpest() - other.shape.sharpest()) > worth_it_deg)
    return made.shape.sharpest() > other.shape.sharpest();
  return made.shape.least_angle_deg > other.shape.least_angle_deg;
}

bool TrialOrder::gains(const SurfaceTrial& made, const SurfaceTrial& best) const {
  if (made.failed() || best.failed()) return best.failed() && !made.failed();
  if (made.is_other_part != best.is_other_part) return best.is_other_part;
  if (holds(made) != holds(best)) return holds(made);
  if (!holds(made) && made.gave_way() != best.gave_way()) return best.gave_way();
  if (!holds(made)) return made.candidate.largest_deviation < worth_it_of_deviation * best.candidate.largest_deviation;
  if (!is_shapely(best)) return made.mean_edge_ratio < best.mean_edge_ratio;
  return made.shape.sharpest() > best.shape.sharpest() + worth_it_deg;
}

std::string TrialOrder::verdict(const SurfaceTrial& made) const {
  const std::string surface = "the surface of " + std::to_string(made.candidate.faces()) + " triangles ";
  if (made.failed()) return surface + "failed: " + made.candidate.failure;
  std::string faults;
  const auto add = [&](const std::string& fault) { faults += (faults.empty() ? "" : "; ") + fault; };
  if (!holds(made))
    add(error_text(made.candidate.largest_deviation / deviation->distance, 3) +
        " times as far from the scan as is wanted");
  if (!is_shapely(made))
    add("its mean edge ratio is " + error_text(made.mean_edge_ratio, 3) + ", above " +
        error_text(worst_mean_edge_ratio, 3));
  if (made.is_other_part) add("it has none of the part's edges");
  if (!made.shape.empty())
    add(std::to_string(made.shape.bad.size()) + " places are badly shaped, the sharpest angle " +
        error_text(made.shape.sharpest(), 3) + " deg");
  if (!made.candidate.fallback_reason.empty()) add("the lattice had failed: " + made.candidate.fallback_reason);
  if (is_accepted(made)) return surface + "is accepted" + (faults.empty() ? "" : ", though " + faults);
  return surface + "is not accepted: " + faults;
}

}  // namespace scan2fea
