#include "preproc/surface/features/curve_sampling.hpp"

#include "preproc/surface/features/find_features.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "tests/analytic_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace scan2fea {
namespace {

struct Sampled {
  FeatureCurves features;
  std::vector<std::vector<double>> samples;
};

Sampled sample(const SurfaceMesh& mesh, const std::vector<double>& edge_length, double tolerance) {
  Sampled result;
  result.features = trace_feature_curves(mesh.vertices, find_features(mesh).edges, boundary_edges(mesh), edge_length);
  result.samples = sample_curves(mesh, result.features, edge_length, {.tolerance = tolerance});
  return result;
}
Sampled sample(const SurfaceMesh& mesh, double edge_length, double tolerance) {
  return sample(mesh, std::vector<double>(mesh.vertices.size(), edge_length), tolerance);
}

// What the header promises of every sampling.
void expect_valid(const Sampled& s) {
  ASSERT_EQ(s.samples.size(), s.features.curves.size());
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> bare_chords;
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    const FeatureCurve& curve = s.features.curves[i];
    const std::vector<double>& at = s.samples[i];
    const auto n = static_cast<double>(curve.vertices.size());
    for (std::size_t k = 0; k + 1 < at.size(); ++k) EXPECT_LT(at[k], at[k + 1]);
    if (curve.closed) {
      EXPECT_GE(at.size(), 3U);
      EXPECT_GE(at.front(), 0);
      EXPECT_LT(at.back(), n);
    } else {
      EXPECT_EQ(at.front(), 0);
      EXPECT_EQ(at.back(), n - 1);
      const auto ends = std::minmax(curve.vertices.front(), curve.vertices.back());
      if (ends.first == ends.second) {
        EXPECT_GE(at.size(), 4U);
      }
      if (at.size() == 2) {
        EXPECT_EQ(++bare_chords[ends], 1);
      }
    }
  }
}

std::vector<double> chord_lengths(const SurfaceMesh& mesh, const FeatureCurve& curve, const std::vector<double>& at) {
  std::vector<double> lengths;
  for (std::size_t k = 0; k + (curve.closed ? 0 : 1) < at.size(); ++k)
    lengths.push_back((curve_point(mesh, curve, at[k]) - curve_point(mesh, curve, at[(k + 1) % at.size()])).norm());
  return lengths;
}

TEST(CurveSampling, StraightEdgesAreDividedEvenly) {
  const SurfaceMesh coarse = analytic::box({2, 3, 5}, 10), fine = analytic::box({2, 3, 5}, 0.11);
  for (const SurfaceMesh& box : {coarse, fine}) {
    const Sampled s = sample(box, 0.37, 0.001);
    expect_valid(s);
    for (std::size_t i = 0; i < s.samples.size(); ++i) {
      const std::vector<double> lengths = chord_lengths(box, s.features.curves[i], s.samples[i]);
      const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
      EXPECT_LT(*most / *least, 1.06);
      EXPECT_NEAR(*most, 0.37, 0.15 * 0.37);  // whole numbers of steps
    }
  }
}

TEST(CurveSampling, SpacingFollowsTheWantedLength) {
  const SurfaceMesh box = analytic::box({10, 1, 1}, 0.25);
  std::vector<double> wanted;
  for (const Vec3& v : box.vertices) wanted.push_back(0.2 + 0.06 * v[0]);
  const Sampled s = sample(box, wanted, 0.001);
  expect_valid(s);
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    const FeatureCurve& curve = s.features.curves[i];
    for (std::size_t k = 0; k + 1 < s.samples[i].size(); ++k) {
      const Vec3 a = curve_point(box, curve, s.samples[i][k]), b = curve_point(box, curve, s.samples[i][k + 1]);
      const double h = 0.2 + 0.03 * (a + b)[0];
      if ((a - b).norm() < 0.99) {  // not the edges of length 1, which have no room
        EXPECT_NEAR((a - b).norm() / h, 1, 0.25);
      }
    }
  }
}

TEST(CurveSampling, ChordsStayWithinTheTolerance) {
  const SurfaceMesh cylinder = analytic::cylinder(1, 3, 400, 2);
  for (const double tolerance : {0.02, 0.005, 0.001}) {
    const Sampled s = sample(cylinder, 0.5, tolerance);
    expect_valid(s);
    for (std::size_t i = 0; i < s.samples.size(); ++i)
      for (const double l : chord_lengths(cylinder, s.features.curves[i], s.samples[i]))
        EXPECT_LT(1 - std::sqrt(1 - l * l / 4), tolerance);  // the sagitta
  }
}

TEST(CurveSampling, LoopsKeepThreeSamplesHoweverCoarse) {
  const SurfaceMesh cylinder = analytic::cylinder(1, 3, 40, 2);
  for (const double edge_length : {0.5, 2.0, 6.0, 100.0}) expect_valid(sample(cylinder, edge_length, 10));
}

TEST(CurveSampling, LoopsAreDividedEvenly) {
  const SurfaceMesh cylinder = analytic::cylinder(1, 3, 400, 2);
  const Sampled s = sample(cylinder, 0.21, 0.1);
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    const std::vector<double> lengths = chord_lengths(cylinder, s.features.curves[i], s.samples[i]);
    const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
    EXPECT_LT(*most / *least, 1.06);
  }
}

TEST(CurveSampling, BendsBelowTheCornerLimitAreSampled) {
  // Octagons: a turn of 45 degrees is a corner, one of 36, of the decagon, is not; its bends must be kept all the same.
  const SurfaceMesh prism = analytic::cylinder(1, 3, 10, 1);
  const Sampled s = sample(prism, 0.25, 0.0005);
  expect_valid(s);
  for (std::size_t i = 0; i < s.samples.size(); ++i) {
    ASSERT_TRUE(s.features.curves[i].closed);
    for (int v = 0; v < 10; ++v)
      EXPECT_TRUE(std::any_of(s.samples[i].begin(), s.samples[i].end(), [&](double t) {
        return std::abs(t - v) < 1e-6;
      })) << v;
  }
}

TEST(CurveSampling, CurvesBetweenTheSameCornersStayApart) {
  // A disc whose border is two arcs between two corners.
  SurfaceMesh lens;
  const int n = 20;
  for (int i = 0; i < 2 * n; ++i) {
    const double x = i < n ? -1 + 2.0 * i / n : 1 - 2.0 * (i - n) / n;
    lens.vertices.emplace_back(x, (i < n ? -1 : 1) * 0.9 * (1 - x * x), 0);
  }
  lens.vertices.emplace_back(0, 0, 0);
  for (std::uint32_t i = 0; i < 2 * n; ++i) lens.triangles.push_back({2 * n, i, (i + 1) % (2 * n)});
  for (const double edge_length : {0.2, 1.0, 10.0}) {
    const Sampled s = sample(lens, edge_length, 10);
    expect_valid(s);
  }
}

TEST(CurveSampling, IsTheSameTwice) {
  const SurfaceMesh slab = analytic::slab_with_holes(2, 0.25);
  EXPECT_EQ(sample(slab, 0.33, 0.001).samples, sample(slab, 0.33, 0.001).samples);
}

}  // namespace
}  // namespace scan2fea
