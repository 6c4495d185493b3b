// Nelder and Mead's downhill simplex search in a plane: it asks for values alone, so it serves costs that have no
// gradient everywhere, such as the entropy of sorted ratios.
// Source: [1], sections 2 and 3 (README.md lists the sources), where it finds a vertex's place in the tangent plane of
// its star; Nelder and Mead, "A simplex method for function minimization", The Computer Journal 7, 1965, with their
// coefficients: reflection 1, expansion 2, contraction 1/2, shrinking 1/2.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>

namespace scan2fea {

// The best corner of the last triangle. The search starts at the origin, where the cost is `start_cost`, with a right
// triangle of legs `size`; it ends once cost(x) has been asked for `evaluations` times (it may ask three more times, to
// end the step at hand) or the best and the worst corner are within 1e-4 of `size`. The cost may be infinite where a
// constraint is broken. Never worse than the start. Not guaranteed: a minimum, even a local one.
template <class Cost>
Eigen::Vector2d minimise_by_simplex(const Cost& cost, double start_cost, double size, int evaluations) {
  using Vec2 = Eigen::Vector2d;
  struct Corner {
    Vec2 x;
    double cost;
  };
  const auto at = [&](const Vec2& x) {
    --evaluations;
    return Corner{x, cost(x)};
  };
  // Stable: corners of equal cost keep their order, so that the search is the same everywhere.
  const auto by_cost = [](const Corner& a, const Corner& b) { return a.cost < b.cost; };
  std::array<Corner, 3> simplex{Corner{Vec2::Zero(), start_cost}, at(Vec2(size, 0)), at(Vec2(0, size))};
  while (evaluations > 0) {
    std::stable_sort(simplex.begin(), simplex.end(), by_cost);
    auto& [best, middle, worst] = simplex;
    if ((worst.x - best.x).norm() < 1e-4 * size) break;
    const Vec2 base = 0.5 * (best.x + middle.x);
    const Corner reflected = at(base + (base - worst.x));
    if (reflected.cost < best.cost) {
      const Corner expanded = at(base + 2 * (base - worst.x));
      worst = expanded.cost < reflected.cost ? expanded : reflected;
    } else if (reflected.cost < middle.cost) {
      worst = reflected;
    } else {
      const bool outside = reflected.cost < worst.cost;
      const Corner contracted = at(base + (outside ? 0.5 : -0.5) * (base - worst.x));
      if (contracted.cost < std::min(reflected.cost, worst.cost)) {
        worst = contracted;
      } else {
        middle = at(0.5 * (best.x + middle.x));
        worst = at(0.5 * (best.x + worst.x));
      }
    }
  }
  return std::min_element(simplex.begin(), simplex.end(), by_cost)->x;
}

}  // namespace scan2fea
