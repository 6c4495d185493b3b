// Moves one vertex in the tangent plane of its star so that the star's objective becomes best, then lifts it.
// Source: [1], sections 2 and 3 (Nelder-Mead in the tangent plane, then lifting; README.md lists the sources). The
// smooth objective, Phi of eta, is minimised by Newton's method instead, at a fifteenth of the cost.
#pragma once

#include "preproc/surface/placement/star_objective.hpp"

#include <functional>
#include <span>

namespace scan2fea {

// A closed star: the triangles (centre, link[i], link[i + 1]), counter-clockwise about `normal`.
struct Star {
  Vec3 centre = Vec3::Zero();
  std::span<const Vec3> link;  // at least 3 points, cyclic
};

struct PlaceVertexOptions {
  StarObjective objective = StarObjective::entropy_weighted;

  // Cosine of the largest angle between a triangle's normal and the star's, before and after lifting, in (0, 1): the
  // hard constraint. 0.05 (87 degrees) bars inverted triangles and leaves everything else to the objective.
  double smallest_normal_cosine = 0.05;

  // Newton steps for entropy_weighted, 1 to 20. Four end within a hundredth of an edge of the optimum, even from a
  // start half-way to the link.
  int newton_steps = 4;

  // Evaluations of the star by Nelder-Mead for the other objectives, 10 to 1000; 60 shrinks the simplex about a
  // thousandfold.
  int simplex_evaluations = 60;
};

struct PlaceVertexResult {
  Vec3 position = Vec3::Zero();  // lifted
  bool feasible = false;         // false: no place was found that satisfies the constraint; `position` is the centre
  double cost = 0;               // star_cost at `position`; infinite where not feasible
};

// From a point of the tangent plane to the surface.
using Lift = std::function<Vec3(const Vec3&)>;

// The area-weighted unit normal of the star, which depends on the link alone; zero where the link encloses no area.
Vec3 star_normal(std::span<const Vec3> link);

// True where every triangle's normal is within the limit of `normal` (unit).
bool is_star_feasible(const Star& star, const Vec3& normal, double smallest_normal_cosine);

double star_cost(StarObjective objective, const Star& star);

// The search starts at the star's centre, or at the link's mean where the centre is not feasible, and stays in the
// plane through the start with `normal` (unit). Where the lifted optimum breaks the constraint, points half-way, and
// half-way again to the start are tried. The result is never worse in the plane than the start; lifting may make it so.
// Not guaranteed: a global optimum (the literal entropies have many local ones).
PlaceVertexResult place_vertex(const Star& star, const Vec3& normal, const PlaceVertexOptions& options = {},
                               const Lift& lift = {});

}  // namespace scan2fea
