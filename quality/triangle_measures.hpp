// Shape of triangles, in the measures of Verdict (Stimpson et al., "The Verdict geometric quality library", 2007).
//
// Angles come from atan2 of the area against the corner's dot product, which is accurate to the last digits for needles
// and caps where arc cosines of edge lengths lose half of them; everything is scaled by the triangle first, so that
// neither the unit nor the distance from the origin matters beyond the coordinates' own rounding.
//
// A triangle of zero area (in double precision, after scaling) has no shape: its edge ratio or smallest angle would be
// infinite or undefined. It is counted in `degenerate` and enters no other figure, so every figure is finite.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

namespace scan2fea {

struct TriangleShape {
  double edge_ratio;     // longest edge / shortest edge: 1 for equilateral, 1.414 for a right isosceles triangle
  double min_angle_deg;  // 60 for equilateral
  double max_angle_deg;
  double radius_ratio;  // 2 * inscribed radius / circumscribed radius: 1 for equilateral, 0 for zero area
};

// Longest edge over shortest edge: AR of [1], sections 2 and 3. Infinite where two corners coincide; 2 at most for a
// flat triangle with its apex in the middle, so that it does not bar degenerate triangles.
double edge_ratio(const Vec3& a, const Vec3& b, const Vec3& c);

// eta = (l1^2 + l2^2 + l3^2) / (4 sqrt(3) area) >= 1. Infinite for every degenerate triangle: a barrier.
double eta(const Vec3& a, const Vec3& b, const Vec3& c);

// Nothing for a triangle of zero area.
std::optional<TriangleShape> measure_triangle(const Vec3& a, const Vec3& b, const Vec3& c);

// Radians, 0 to pi; accurate to the last digits for small ones, too. 0 where one of them has no length.
double angle_between(const Vec3& u, const Vec3& v);

// At the apex between two other points.
double angle_deg(const Vec3& apex, const Vec3& a, const Vec3& b);

double smallest_angle_deg(const Vec3& a, const Vec3& b, const Vec3& c);

// The angle between two triangles on the side that their normals point away from, radians, (0, 2 pi): that of the body,
// if they face outwards. `along`: unit, the edge that they share, as the first one turns; the normals have any length.
double interior_angle(const Vec3& first_normal, const Vec3& second_normal, const Vec3& along);

// Of a triangle with edges of length 1.
inline constexpr double equilateral_area = std::numbers::sqrt3 / 4;

// Of so many equilateral triangles that have this area together.
inline double equilateral_edge(double area, double triangles) {
  return std::sqrt(area / (equilateral_area * triangles));
}

struct TriangleSummary {
  std::size_t measured = 0;    // triangles in the figures below; where it is 0, so are they
  std::size_t degenerate = 0;  // triangles of zero area
  // The p-th percentile of n sorted values is the one with index floor(p * n), counted from 0.
  struct {
    double mean = 0, p50 = 0, p95 = 0, p99 = 0, max = 0;
  } edge_ratio;
  struct {
    double mean = 0, min = 0;
  } min_angle_deg;  // of each triangle's smallest angle
  double max_angle_deg = 0;
  struct {
    double mean = 0, min = 0;
  } radius_ratio;
};

// O(n), parallel; sums run in the order of the triangles, so the result does not depend on the number of threads.
TriangleSummary measure_triangles(const SurfaceMesh& mesh);

}  // namespace scan2fea
