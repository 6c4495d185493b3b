// Objectives of a vertex's star: one number for how good its triangles are together, a function of their ratios.
// Source: [1], eq. 2 and eq. 3 (Shannon entropy and A-entropy of the edge ratios; README.md lists the sources), and
// two objectives that keep its idea and do make triangles equilateral: eq. 2 is blind to the level of the ratios, eq. 3
// is largest where they are equally spaced, so neither does alone. All functions take N >= 1 ratios, each >= 1 (1 for
// an equilateral triangle), and cost O(N) or O(N log N).
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace scan2fea {

enum class StarObjective {
  shannon,                // eq. 2, maximised
  a_entropy,              // eq. 3, maximised
  regularised_a_entropy,  // J: mean edge ratio less a fifth of a smoothed, normalised eq. 3; minimised
  entropy_weighted,       // Phi: mean of M ln M with M = eta; minimised
  mean_edge_ratio,        // minimised
};

// As on the command line: "shannon", "a-entropy", "regularised-a-entropy", "entropy-weighted", "mean-edge-ratio".
std::string_view name_of(StarObjective objective);
std::optional<StarObjective> star_objective_named(std::string_view name);

// Eq. 2: S = -sum p_i ln p_i, p_i = M_i / sum M. In [0, ln N], ln N where all ratios are equal.
double shannon_entropy(std::span<const double> ratios);

// Eq. 3: A = -sum p_i ln p_i, p_i = (a_i - a_{i-1}) / (a_n - 1) over the sorted ratios with a_0 = 1; 0 where all are 1.
double a_entropy(std::vector<double> ratios);

// J = (mean - 1) - 0.2 A_e / ln N, with A_e of p_i = (a_i - a_{i-1} + 0.05) / (a_n - 1 + 0.05 N). Squeezes the mean a
// little further than Phi and costs the largest ratio and the smallest angle.
double regularised_a_entropy(std::vector<double> ratios);

// Phi = (1/N) sum M ln M = mean (ln mean + ln N - S): level and entropy deficit in one. Convex, zero only where all
// ratios are 1.
double weighted_entropy(std::span<const double> ratios);

double mean_ratio(std::span<const double> ratios);

// The ratio that the objective is made of: eta for entropy_weighted, the edge ratio for the others.
double triangle_ratio(StarObjective objective, const Vec3& a, const Vec3& b, const Vec3& c);

// The objective as a cost: smaller is better. Infinite where a ratio is infinite.
double star_cost(StarObjective objective, std::span<const double> ratios);

}  // namespace scan2fea
