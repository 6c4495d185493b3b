#include "preproc/bodies/touching_places.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace scan2fea {
namespace {

// Of the diagonal: what coordinates of six digits leave of a place.
constexpr double touching_of_diagonal = 1e-5;
// Sine of the angle between planes that are one.
constexpr double parallel = 1e-4;
// Of the area; and the cosine of normals that are alike.
constexpr double nearly_all = 0.9, alike = 0.85;

struct Corners {
  std::array<Vec3, 3> points;
  Vec3 normal;

  Corners(const SurfaceMesh& mesh, std::uint32_t f) {
    for (std::size_t k = 0; k < 3; ++k) points[k] = mesh.vertices[mesh.triangles[f][k]];
    normal = (points[1] - points[0]).cross(points[2] - points[0]).normalized();
  }
  Vec3 closest(const Vec3& p) const { return closest_point_on_triangle(p, points[0], points[1], points[2]); }
  std::array<double, 3> along(const Vec3& direction) const {
    return {direction.dot(points[0]), direction.dot(points[1]), direction.dot(points[2])};
  }
};

// Of the two intervals; negative where they are apart.
double overlap(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::min(std::ranges::max(a), std::ranges::max(b)) - std::max(std::ranges::min(a), std::ranges::min(b));
}

bool overlap_in_one_plane(const Corners& a, const Corners& b, double nothing) {
  for (const Corners* of : {&a, &b})
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 across = of->normal.cross(of->points[(k + 1) % 3] - of->points[k]).normalized();
      if (overlap(a.along(across), b.along(across)) <= nothing) return false;
    }
  return true;
}

// Where a triangle passes through a plane, as an interval along the direction, which lies in both.
std::optional<std::array<double, 3>> section(const Corners& t, const std::array<double, 3>& heights,
                                             const Vec3& direction) {
  std::vector<double> ends;
  for (std::size_t k = 0; k < 3; ++k) {
    const double from = heights[k], to = heights[(k + 1) % 3];
    if ((from < 0) == (to < 0)) continue;
    const double part = from / (from - to);
    ends.push_back(direction.dot((1 - part) * t.points[k] + part * t.points[(k + 1) % 3]));
  }
  if (ends.size() != 2) return {};
  return std::array{ends[0], ends[1], ends[1]};
}

std::array<double, 3> heights_over(const Corners& plane, const Corners& t) {
  std::array<double, 3> heights;
  for (std::size_t k = 0; k < 3; ++k) heights[k] = plane.normal.dot(t.points[k] - plane.points[0]);
  return heights;
}

// Whether material behind one is in material behind the other.
bool is_crossing(const Corners& a, const Corners& b, double nothing) {
  const Vec3 direction = a.normal.cross(b.normal);
  if (direction.norm() < parallel) return a.normal.dot(b.normal) > 0 && overlap_in_one_plane(a, b, nothing);
  const std::array<double, 3> of_a = heights_over(b, a), of_b = heights_over(a, b);
  for (const auto& heights : {of_a, of_b})
    if (std::ranges::min(heights) > -nothing || std::ranges::max(heights) < nothing) return false;
  const auto first = section(a, of_a, direction.normalized()), second = section(b, of_b, direction.normalized());
  return first && second && overlap(*first, *second) > nothing;
}

std::pair<std::uint32_t, std::uint32_t> bodies_of(const BodyComplex& complex, const FacePair& pair) {
  const Sides &a = complex.sides[pair.face], &b = complex.sides[pair.other];
  for (const std::uint32_t x : {a.behind, a.front})
    for (const std::uint32_t y : {b.behind, b.front})
      if (x != no_body && y != no_body && x != y) return {std::min(x, y), std::max(x, y)};
  return {a.behind, a.behind};
}

double nothing_in(const BodyComplex& complex) {
  return touching_of_diagonal * bounding_box(complex.mesh.vertices).diagonal();
}

void measure(const BodyComplex& complex, TouchingPlace& place) {
  const double nothing = nothing_in(complex);
  std::vector<Vec3> common;
  for (const auto& [face, other] : place.faces) {
    const Corners a(complex.mesh, face), b(complex.mesh, other);
    for (const auto& [of, on] : {std::pair(&a, &b), std::pair(&b, &a)})
      for (const Vec3& p : of->points)
        if ((on->closest(p) - p).norm() <= nothing) common.push_back(p);
  }
  if (common.empty()) common.push_back(centroid(complex.mesh, complex.mesh.triangles[place.faces.front().face]));
  const BoundingBox box = bounding_box(common);
  place.at = (box.low + box.high) / 2;
  place.length = box.diagonal() > nothing ? box.diagonal() : 0;
}

bool lies_on(const SurfaceMesh& mesh, const SurfaceMesh& other, double tolerance) {
  const TriangleTree tree(other);
  const std::vector<Vec3> normals = face_normals(mesh), of_other = face_normals(other);
  double on = 0, all = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const double area = area_vector(mesh, mesh.triangles[f]).norm();
    all += area;
    const auto nearest = tree.closest_within(centroid(mesh, mesh.triangles[f]), tolerance);
    if (nearest && normals[f].dot(of_other[nearest->triangle]) > alike) on += area;
  }
  return on > nearly_all * all;
}

}  // namespace

std::vector<TouchingPlace> find_touching_places(const BodyComplex& complex) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, TouchingPlace> places;
  for (const FacePair& pair : find_self_intersections(complex.mesh)) {
    if (pair.face == pair.other) continue;  // a needle of the cuts
    const auto bodies = bodies_of(complex, pair);
    TouchingPlace& place = places[bodies];
    place.first = bodies.first;
    place.second = bodies.second;
    place.faces.push_back(pair);
  }
  std::vector<TouchingPlace> list;
  for (auto& [bodies, place] : places) {
    measure(complex, place);
    list.push_back(std::move(place));
  }
  return list;
}

bool only_touch(const TouchingPlace& place, const BodyComplex& complex) {
  const double nothing = nothing_in(complex);
  return place.first != place.second && std::ranges::none_of(place.faces, [&](const FacePair& pair) {
           return is_crossing(Corners(complex.mesh, pair.face), Corners(complex.mesh, pair.other), nothing);
         });
}

void draw_back_at(const TouchingPlace& place, const BodyComplex& complex, std::uint32_t body, double distance,
                  SurfaceMesh& surface) {
  const double nothing = nothing_in(complex);
  const TriangleTree tree(surface);
  std::vector<bool> is_moved(surface.vertices.size(), false);
  for (const auto& [face, other] : place.faces) {
    const Sides& sides = complex.sides[face];
    const bool is_own = sides.behind == body || sides.front == body;
    const std::uint32_t own = is_own ? face : other;
    const Corners touched(complex.mesh, is_own ? other : face);
    const Triangle& t = surface.triangles[tree.closest(centroid(complex.mesh, complex.mesh.triangles[own])).triangle];
    const auto touches = [&](std::uint32_t v) {
      return (touched.closest(surface.vertices[v]) - surface.vertices[v]).norm() <= 3 * nothing;
    };
    const bool any = std::ranges::any_of(t, touches);
    for (const std::uint32_t v : t) is_moved[v] = is_moved[v] || !any || touches(v);
  }
  std::vector<Vec3> outwards(surface.vertices.size(), Vec3::Zero());
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &p = surface.vertices[t[k]], a = surface.vertices[t[(k + 1) % 3]] - p,
                 b = surface.vertices[t[(k + 2) % 3]] - p;
      const Vec3 normal = a.cross(b);
      if (normal.norm() > 0) outwards[t[k]] += std::atan2(normal.norm(), a.dot(b)) * normal.normalized();
    }
  for (std::size_t v = 0; v < is_moved.size(); ++v)
    if (is_moved[v]) surface.vertices[v] -= distance * outwards[v].normalized();
}

bool lie_alike(const SurfaceMesh& a, const SurfaceMesh& b, double tolerance) {
  return lies_on(a, b, tolerance) && lies_on(b, a, tolerance);
}

}  // namespace scan2fea
