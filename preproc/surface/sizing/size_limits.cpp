#include "preproc/surface/sizing/size_limits.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/numbers.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/sizing/sizing_field.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "preproc/surface/sizing/triangle_memory.hpp"
#include "quality/face_blocks.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/triangle_tree.hpp"
#include "quality/wall_thickness.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace scan2fea {
namespace {

// The lengths that come out of a lattice scatter about those that it is given.
constexpr double margin = 0.85;
// Of the other edges, so that the count is kept.
constexpr double most_growth = 1.5;

void require(bool good, const char* flag, const char* what, double value, const char* limit) {
  if (!good) throw WrongUsage({.what = what, .where = flag, .value = error_text(value), .limit = limit, .advice = {}});
}

void check(const SizeLimits& limits) {
  for (const SizedBox& b : limits.boxes) {
    require(b.length > 0 && std::isfinite(b.length), "--size-box", "edge length out of range", b.length, "above 0");
    require((b.box.high - b.box.low).minCoeff() >= 0, "--size-box", "the box has no inside: a side is negative",
            (b.box.high - b.box.low).minCoeff(), "the low corner first");
  }
  for (const SizedBall& b : limits.balls) {
    require(b.length > 0 && std::isfinite(b.length), "--size-ball", "edge length out of range", b.length, "above 0");
    require(b.ball.radius > 0, "--size-ball", "radius out of range", b.ball.radius, "above 0");
  }
  if (limits.elements_across)
    require(*limits.elements_across >= 1 && *limits.elements_across <= 10, "--elements-across",
            "elements across a wall out of range", *limits.elements_across, "1 to 10");
}

bool meet(const BoundingBox& a, const BoundingBox& b) {
  return boxes_meet(a, b);
}

bool meet(const BoundingBox& box, const Ball& ball) {
  return (ball.centre - ball.centre.cwiseMax(box.low).cwiseMin(box.high)).norm() <= ball.radius;
}

// By bounding boxes, so that a triangle too many may be limited, but none too few.
double limit_of(const SurfaceMesh& mesh, const Triangle& t, const SizeLimits& limits) {
  const BoundingBox bounds = box_of_face(mesh.vertices, t);
  double limit = infinity;
  for (const auto& [box, length] : limits.boxes)
    if (meet(bounds, box)) limit = std::min(limit, length);
  for (const auto& [ball, length] : limits.balls)
    if (meet(bounds, ball)) limit = std::min(limit, length);
  return limit;
}

// A place in other units, say, would be ignored without a word.
template <class Place>
void require_surface_in(const SurfaceMesh& scan, const Place& place, const char* name, const Vec3& centre) {
  if (std::ranges::any_of(scan.triangles,
                          [&](const Triangle& t) { return meet(box_of_face(scan.vertices, t), place); }))
    return;
  const BoundingBox whole = bounding_box(scan.vertices);
  throw WrongUsage({.what = std::string("no part of the surface is in a size ") + name,
                    .where = error_text(centre),
                    .value = {},
                    .limit = "the scan is from " + error_text(whole.low) + " to " + error_text(whole.high),
                    .advice = "coordinates of the scan's own unit"});
}

void lower(std::vector<double>& limit, const Triangle& t, double to) {
  for (const std::uint32_t v : t) limit[v] = std::min(limit[v], to);
}

void limit_across(const SurfaceMesh& scan, int elements, double longest_edge, std::vector<double>& limit) {
  const TriangleTree tree(scan);
  const std::vector<Vec3> normals = face_normals(scan);
  std::vector<double> thickness(scan.triangles.size());
  for_each_block(scan.triangles.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t f = first; f < last; ++f) {
      const Triangle& t = scan.triangles[f];
      const Vec3 middle = centroid(scan, t);
      const auto wall = find_wall(scan, tree, middle, normals[f], {.deepest = elements * longest_edge});
      thickness[f] = wall ? wall->thickness : infinity;
    }
  });
  for (std::size_t f = 0; f < thickness.size(); ++f) lower(limit, scan.triangles[f], thickness[f] / elements);
}

// Triangles that lie in limits with all corners become at least so many.
double least_triangles(const SurfaceMesh& scan, const SizeLimits& limits) {
  double sum = 0;
  for (const Triangle& t : scan.triangles) {
    double length = infinity;
    const auto lies_in = [&](const auto& contains) {
      return std::ranges::all_of(t, [&](std::uint32_t v) { return contains(scan.vertices[v]); });
    };
    for (const auto& [box, limit] : limits.boxes)
      if (lies_in([&](const Vec3& p) { return (p.array() >= box.low.array() && p.array() <= box.high.array()).all(); }))
        length = std::min(length, limit);
    for (const auto& [ball, limit] : limits.balls)
      if (lies_in([&](const Vec3& p) { return (p - ball.centre).norm() <= ball.radius; }))
        length = std::min(length, limit);
    if (length < infinity) sum += 0.5 * area_vector(scan, t).norm() / (equilateral_area * length * length);
  }
  return sum;
}

}  // namespace

void refine_within_limits(SurfaceMesh& scan, std::vector<FeatureEdge>& features, const SizeLimits& limits) {
  constexpr int most_passes = 24;
  check(limits);
  for (const auto& [box, length] : limits.boxes) require_surface_in(scan, box, "box", (box.low + box.high) / 2);
  for (const auto& [ball, length] : limits.balls) require_surface_in(scan, ball, "ball", ball.centre);
  for (int pass = 0; pass < most_passes; ++pass) {
    require_memory_of_triangles(least_triangles(scan, limits),
                                "longer edges in --size-box or --size-ball, or a smaller box or ball");
    std::vector<double> length(scan.vertices.size(), infinity);
    for (const Triangle& t : scan.triangles) {
      const double limit = limit_of(scan, t, limits);
      if (limit < infinity) lower(length, t, limit);
    }
    // Only edges with both ends in limits count, as the mean of their lengths is infinite otherwise; a triangle that
    // reaches into a limit has three.
    const std::size_t before = scan.vertices.size();
    halve_long_edges(scan, length, features, 1, 1, 1);
    if (scan.vertices.size() == before) return;
  }
}

std::vector<double> longest_edges(const SurfaceMesh& scan, const SizeLimits& limits, double longest_edge) {
  check(limits);
  std::vector<double> limit(scan.vertices.size(), infinity);
  for (const Triangle& t : scan.triangles) lower(limit, t, limit_of(scan, t, limits));
  if (limits.elements_across) limit_across(scan, *limits.elements_across, longest_edge, limit);
  for (double& l : limit) l *= margin;
  return limit;
}

std::vector<double> within_limits(const SurfaceMesh& scan, const std::vector<double>& wanted,
                                  std::span<const double> longest, double gradation, std::optional<double> triangles) {
  const auto grown = [&](double factor) {
    std::vector<double> length(wanted.size());
    for (std::size_t v = 0; v < length.size(); ++v) length[v] = std::min(factor * wanted[v], longest[v]);
    limit_gradation(scan, gradation, length);
    return length;
  };
  std::vector<double> result = grown(1);
  if (!triangles || predicted_triangles(scan, {result}) <= *triangles) return result;
  double low = 1, high = most_growth;
  for (int step = 0; step < 8; ++step) {
    const double factor = step == 0 ? high : (low + high) / 2;
    result = grown(factor);
    const bool enough = predicted_triangles(scan, {result}) <= *triangles;
    if (step == 0 && !enough) return result;
    (enough ? high : low) = factor;
  }
  return grown(high);
}

}  // namespace scan2fea
