#include "preproc/surface/placement/star_objective.hpp"

#include "quality/triangle_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace scan2fea {
namespace {

using Ratios = std::vector<double>;

constexpr StarObjective all_objectives[] = {StarObjective::shannon, StarObjective::a_entropy,
                                            StarObjective::regularised_a_entropy, StarObjective::entropy_weighted,
                                            StarObjective::mean_edge_ratio};

Ratios random_ratios(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> ratio(1, 4);
  Ratios ratios(count);
  for (double& m : ratios) m = ratio(random);
  return ratios;
}

TEST(StarEntropy, ShannonHasTheValuesOfEquation2) {
  EXPECT_NEAR(shannon_entropy(Ratios{1, 2, 3}), 1.01140, 5e-6);
  EXPECT_NEAR(shannon_entropy(Ratios{1.7}), 0, 1e-15);
}

TEST(StarEntropy, EqualRatiosMaximiseShannon) {
  for (std::size_t n : {2U, 6U, 11U}) {
    EXPECT_NEAR(shannon_entropy(Ratios(n, 1.3)), std::log(n), 1e-12);
    EXPECT_LT(shannon_entropy(random_ratios(n, 3)), std::log(n));
  }
}

TEST(StarEntropy, ShannonIsBlindToTheLevel) {
  Ratios ratios = random_ratios(6, 1);
  const double before = shannon_entropy(ratios);
  for (double& m : ratios) m *= 5;
  EXPECT_NEAR(shannon_entropy(ratios), before, 1e-12);
}

TEST(StarEntropy, AEntropyHasTheValuesOfEquation3) {
  EXPECT_NEAR(a_entropy({1.5, 2}), std::log(2), 1e-12);
  EXPECT_NEAR(a_entropy({2, 1.5}), std::log(2), 1e-12);
  EXPECT_EQ(a_entropy({2, 2, 2}), 0);
  EXPECT_EQ(a_entropy({1, 1, 1, 1}), 0);
}

TEST(StarEntropy, AEntropyIsLargestForEquallySpacedRatios) {
  const Ratios spaced{1.5, 2, 2.5, 3};
  EXPECT_NEAR(a_entropy(spaced), std::log(4), 1e-12);
  EXPECT_LT(a_entropy({1.4, 2, 2.5, 3}), a_entropy(spaced));
  EXPECT_GT(a_entropy(spaced), a_entropy({1, 1, 1, 1})) << "the literal objective prefers these to equilateral ones";
}

TEST(StarEntropy, RegularisedAEntropyFollowsItsDefinition) {
  // Sorted 1.5, 2: p = (0.55, 0.55) / 1.1.
  EXPECT_NEAR(regularised_a_entropy({2, 1.5}), 0.75 - 0.2, 1e-12);
  // All equal to 1: every p is 1/n, so that A_e / ln n is 1.
  EXPECT_NEAR(regularised_a_entropy({1, 1, 1}), -0.2, 1e-12);
  EXPECT_NEAR(regularised_a_entropy({1.6}), 0.6, 1e-12);
}

TEST(StarEntropy, WeightedEntropyJoinsLevelAndEntropyDeficit) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Ratios ratios = random_ratios(3 + seed, seed);
    const double mean = mean_ratio(ratios), n = static_cast<double>(ratios.size());
    EXPECT_NEAR(weighted_entropy(ratios), mean * (std::log(mean) + std::log(n) - shannon_entropy(ratios)), 1e-12);
    EXPECT_GT(weighted_entropy(ratios), 0);
  }
  EXPECT_EQ(weighted_entropy(Ratios{1, 1, 1, 1, 1}), 0);
}

TEST(TriangleRatio, EquilateralIsOne) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0.5, std::sqrt(0.75), 0);
  EXPECT_NEAR(edge_ratio(a, b, c), 1, 1e-12);
  EXPECT_NEAR(eta(a, b, c), 1, 1e-12);
  EXPECT_GE(eta(a, b, c), 1);
}

TEST(TriangleRatio, RightTriangle) {
  const Vec3 a(0, 0, 0), b(3, 0, 0), c(0, 0, 4);
  EXPECT_NEAR(edge_ratio(a, b, c), 5.0 / 3, 1e-12);
  EXPECT_NEAR(eta(a, b, c), 50 / (4 * std::sqrt(3.0) * 6), 1e-12);
}

TEST(TriangleRatio, OnlyEtaBarsACap) {
  const Vec3 a(0, 0, 0), b(2, 0, 0), flat(1, 0, 0);
  EXPECT_EQ(edge_ratio(a, b, flat), 2);
  EXPECT_EQ(eta(a, b, flat), std::numeric_limits<double>::infinity());
  EXPECT_EQ(edge_ratio(a, a, b), std::numeric_limits<double>::infinity());
}

TEST(StarObjectiveName, RoundTrips) {
  for (const StarObjective objective : all_objectives) EXPECT_EQ(star_objective_named(name_of(objective)), objective);
  EXPECT_EQ(name_of(StarObjective::entropy_weighted), "entropy-weighted");
  EXPECT_EQ(star_objective_named("midpoint"), std::nullopt);
}

TEST(StarCost, SmallerIsBetterAndDegenerateIsInfinite) {
  EXPECT_LT(star_cost(StarObjective::shannon, Ratios{2, 2, 2}), star_cost(StarObjective::shannon, Ratios{1, 2, 3}));
  EXPECT_LT(star_cost(StarObjective::a_entropy, Ratios{1.5, 2}), star_cost(StarObjective::a_entropy, Ratios{2, 2}));
  EXPECT_LT(star_cost(StarObjective::mean_edge_ratio, Ratios{1, 1}),
            star_cost(StarObjective::mean_edge_ratio, Ratios{1, 2}));
  const Ratios degenerate{1, std::numeric_limits<double>::infinity(), 2};
  for (const StarObjective objective : all_objectives) EXPECT_FALSE(std::isfinite(star_cost(objective, degenerate)));
}

}  // namespace
}  // namespace scan2fea
