#include "preproc/surface/placement/star_objective.hpp"

#include "preproc/mesh/names.hpp"
#include "preproc/mesh/numbers.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

constexpr NameTable<StarObjective, 5> objective_names{{
    {StarObjective::shannon, "shannon"},
    {StarObjective::a_entropy, "a-entropy"},
    {StarObjective::regularised_a_entropy, "regularised-a-entropy"},
    {StarObjective::entropy_weighted, "entropy-weighted"},
    {StarObjective::mean_edge_ratio, "mean-edge-ratio"},
}};

double entropy_term(double p) {
  return p > 0 ? -p * std::log(p) : 0;
}

// Entropy of the gaps between the sorted ratios, each gap widened by `padding`.
double gap_entropy(std::vector<double>& ratios, double padding) {
  std::sort(ratios.begin(), ratios.end());
  const double total = ratios.back() - 1 + padding * static_cast<double>(ratios.size());
  if (total <= 0) return 0;
  double entropy = 0, previous = 1;
  for (const double a : ratios) {
    entropy += entropy_term((a - previous + padding) / total);
    previous = a;
  }
  return entropy;
}

}  // namespace

std::string_view name_of(StarObjective objective) {
  return name_in(objective_names, objective);
}

std::optional<StarObjective> star_objective_named(std::string_view name) {
  return value_in(objective_names, name);
}

double shannon_entropy(std::span<const double> ratios) {
  double sum = 0, entropy = 0;
  for (const double m : ratios) sum += m;
  for (const double m : ratios) entropy += entropy_term(m / sum);
  return entropy;
}

double a_entropy(std::vector<double> ratios) {
  return gap_entropy(ratios, 0);
}

double regularised_a_entropy(std::vector<double> ratios) {
  const double level = mean_ratio(ratios) - 1;
  if (ratios.size() < 2) return level;
  return level - 0.2 * gap_entropy(ratios, 0.05) / std::log(static_cast<double>(ratios.size()));
}

double weighted_entropy(std::span<const double> ratios) {
  double sum = 0;
  for (const double m : ratios) sum += m * std::log(m);
  return sum / static_cast<double>(ratios.size());
}

double mean_ratio(std::span<const double> ratios) {
  double sum = 0;
  for (const double m : ratios) sum += m;
  return sum / static_cast<double>(ratios.size());
}

double triangle_ratio(StarObjective objective, const Vec3& a, const Vec3& b, const Vec3& c) {
  return objective == StarObjective::entropy_weighted ? eta(a, b, c) : edge_ratio(a, b, c);
}

double star_cost(StarObjective objective, std::span<const double> ratios) {
  for (const double m : ratios)
    if (!std::isfinite(m)) return infinity;
  switch (objective) {
    case StarObjective::shannon:
      return -shannon_entropy(ratios);
    case StarObjective::a_entropy:
      return -a_entropy({ratios.begin(), ratios.end()});
    case StarObjective::regularised_a_entropy:
      return regularised_a_entropy({ratios.begin(), ratios.end()});
    case StarObjective::entropy_weighted:
      return weighted_entropy(ratios);
    case StarObjective::mean_edge_ratio:
      return mean_ratio(ratios);
  }
  return infinity;
}

}  // namespace scan2fea
