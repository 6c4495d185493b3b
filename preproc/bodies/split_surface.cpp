#include "preproc/bodies/split_surface.hpp"

#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace scan2fea {
namespace {

bool has_corner(const Triangle& t, std::uint32_t v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

Vec3 nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double dd = d.squaredNorm();
  return a + (dd > 0 ? std::clamp(d.dot(p - a) / dd, 0.0, 1.0) : 0) * d;
}

}  // namespace

SplitSurface::SplitSurface(SurfaceMesh mesh)
    : mesh_(std::move(mesh)),
      origin_(mesh_.triangles.size()),
      split_from_(mesh_.triangles.size()),
      parts_(mesh_.triangles.size()),
      around_(mesh_.vertices.size()) {
  for (std::uint32_t f = 0; f < origin_.size(); ++f) {
    origin_[f] = split_from_[f] = f;
    parts_[f] = {f};
    for (const std::uint32_t v : mesh_.triangles[f]) around_[v].push_back(f);
  }
}

bool SplitSurface::has_edge(std::uint32_t a, std::uint32_t b) const {
  return std::ranges::any_of(around_[a], [&](std::uint32_t f) { return has_corner(mesh_.triangles[f], b); });
}

std::uint32_t SplitSurface::add_vertex(const Vec3& point) {
  mesh_.vertices.push_back(point);
  around_.emplace_back();
  return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
}

std::uint32_t SplitSurface::add_part(std::uint32_t of, const Triangle& corners) {
  const auto f = static_cast<std::uint32_t>(mesh_.triangles.size());
  mesh_.triangles.push_back(corners);
  origin_.push_back(origin_[of]);
  split_from_.push_back(of);
  parts_[origin_[of]].push_back(f);
  for (const std::uint32_t v : corners) around_[v].push_back(f);
  return f;
}

void SplitSurface::replace_corner(std::uint32_t f, std::uint32_t old, std::uint32_t v) {
  for (std::uint32_t& corner : mesh_.triangles[f])
    if (corner == old) corner = v;
  std::erase(around_[old], f);
  around_[v].push_back(f);
}

std::uint32_t SplitSurface::split_edge(std::uint32_t a, std::uint32_t b, const Vec3& point) {
  std::vector<std::uint32_t> of_edge;
  for (const std::uint32_t f : around_[a])
    if (has_corner(mesh_.triangles[f], b)) of_edge.push_back(f);
  const std::uint32_t v = add_vertex(point);
  for (const std::uint32_t f : of_edge) {
    Triangle other = mesh_.triangles[f];
    for (std::uint32_t& corner : other)
      if (corner == a) corner = v;
    replace_corner(f, b, v);
    add_part(f, other);
  }
  return v;
}

std::uint32_t SplitSurface::split_triangle(std::uint32_t f, const Vec3& point) {
  const Triangle t = mesh_.triangles[f];
  const std::uint32_t v = add_vertex(point);
  replace_corner(f, t[2], v);
  add_part(f, {t[1], t[2], v});
  add_part(f, {t[2], t[0], v});
  return v;
}

std::uint32_t SplitSurface::insert(std::uint32_t given, const Vec3& point, double snap) {
  struct Nearest {
    double squared = std::numeric_limits<double>::infinity();
    std::uint32_t a = 0, b = 0;
  };
  Nearest vertex, edge, inside;
  for (const std::uint32_t f : parts_[given]) {
    const Triangle& t = mesh_.triangles[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (const double d = (this->point(a) - point).squaredNorm(); d < vertex.squared) vertex = {d, a, a};
      const double d = (nearest_on_segment(point, this->point(a), this->point(b)) - point).squaredNorm();
      if (d < edge.squared) edge = {d, a, b};
    }
    const double d = (closest_point_on_triangle(point, this->point(t[0]), this->point(t[1]), this->point(t[2])) - point)
                         .squaredNorm();
    if (d < inside.squared) inside = {d, f, f};
  }
  if (vertex.squared <= snap * snap) return vertex.a;
  if (edge.squared <= snap * snap)
    return split_edge(edge.a, edge.b, nearest_on_segment(point, this->point(edge.a), this->point(edge.b)));
  return split_triangle(inside.a, point);
}

}  // namespace scan2fea
