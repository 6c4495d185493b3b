#include "preproc/volume/descent.hpp"

#include <cmath>
#include <deque>
#include <limits>
#include <ranges>
#include <vector>

namespace scan2fea {
namespace {

struct Change {
  Eigen::VectorXd x, gradient;
  double curvature;  // their product, > 0
};

// Against the gradient, in the metric that the last changes tell of.
Eigen::VectorXd descent_direction(const Eigen::VectorXd& gradient, const std::deque<Change>& changes) {
  Eigen::VectorXd d = -gradient;
  std::vector<double> along;
  for (const Change& change : changes | std::views::reverse) {
    along.push_back(change.x.dot(d) / change.curvature);
    d -= along.back() * change.gradient;
  }
  if (!changes.empty()) d *= changes.back().curvature / changes.back().gradient.squaredNorm();
  for (const Change& change : changes) {
    d += (along.back() - change.gradient.dot(d) / change.curvature) * change.x;
    along.pop_back();
  }
  return d;
}

struct Point {
  Eigen::VectorXd x, gradient;
  double value;
};

// Steps along d, where the slope is `slope`, until the value has fallen enough and the slope has risen enough (the weak
// conditions of Wolfe), by doubling and halving; or at last as far as the value has fallen enough. False where it
// nowhere has.
bool search(const Energy& energy, const Eigen::VectorXd& d, double slope, double length, Point& point) {
  constexpr int most_trials = 20;
  constexpr double sufficient = 1e-4, steep = 0.9;
  double low = 0, high = std::numeric_limits<double>::infinity();
  Point next, lower;
  for (int trial = 0; trial < most_trials; ++trial) {
    next.x = point.x + length * d;
    next.value = energy(next.x, next.gradient);
    if (!(next.value <= point.value + sufficient * length * slope)) {
      high = length;
    } else if (next.gradient.dot(d) < steep * slope) {
      low = length;
      lower = next;
    } else {
      point = std::move(next);
      return true;
    }
    length = std::isfinite(high) ? (low + high) / 2 : 2 * low;
  }
  if (low == 0) return false;
  point = std::move(lower);
  return true;
}

}  // namespace

void descend(const Energy& energy, Eigen::VectorXd& x, int most_steps) {
  constexpr std::size_t most_changes = 8;
  constexpr double first_step = 0.05, longest_step = 0.5, least_gain = 1e-5;
  Point point{x, {}, 0};
  point.value = energy(x, point.gradient);
  std::deque<Change> changes;
  for (int step = 0; step < most_steps && point.gradient.norm() > 0; ++step) {
    Eigen::VectorXd d = descent_direction(point.gradient, changes);
    double slope = d.dot(point.gradient);
    if (!(slope < 0)) {
      changes.clear();
      d = -point.gradient;
      slope = d.dot(point.gradient);
    }
    const double longest = d.lpNorm<Eigen::Infinity>();
    const Point before = point;
    if (!search(energy, d, slope, changes.empty() ? first_step / longest : std::min(1.0, longest_step / longest),
                point)) {
      if (changes.empty()) break;
      changes.clear();
      continue;
    }
    Change change{point.x - before.x, point.gradient - before.gradient, 0};
    change.curvature = change.x.dot(change.gradient);
    if (change.curvature > 0) {
      changes.push_back(std::move(change));
      if (changes.size() > most_changes) changes.pop_front();
    }
    if (before.value - point.value < least_gain * std::abs(point.value)) break;
  }
  x = point.x;
}

}  // namespace scan2fea
