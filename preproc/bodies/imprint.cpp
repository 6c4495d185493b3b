#include "preproc/bodies/imprint.hpp"

#include "preproc/surface/kernel/adjacency.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace scan2fea {
namespace {

constexpr int imprint_bisections = 40;
constexpr std::size_t most_steps = 1000;  // along one edge

// An edge where the surface turns away from what one of its sides lies on.
struct Rim {
  Vec3 from, to;
  std::array<Vec3, 2> normals;
};

std::vector<Rim> find_rims(const SurfaceMesh& mesh, std::span<const std::uint32_t> triangles) {
  const std::vector<Vec3> normals = face_normals(mesh);
  struct Side {
    FeatureEdge edge;
    std::uint32_t triangle;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  for (const std::uint32_t f : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      sides.push_back({feature_edge(mesh.triangles[f][k], mesh.triangles[f][(k + 1) % 3]), f});
  std::sort(sides.begin(), sides.end());
  std::vector<Rim> rims;
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    if (sides[i].edge != sides[i + 1].edge) continue;
    const Vec3 &a = normals[sides[i].triangle], &b = normals[sides[i + 1].triangle];
    if (a.dot(b) < facing) rims.push_back({mesh.vertices[sides[i].edge[0]], mesh.vertices[sides[i].edge[1]], {a, b}});
  }
  return rims;
}

class Imprint {
 public:
  Imprint(SplitSurface& surface, const FacingSurface& on, double tolerance, double step)
      : surface_(surface), on_(on), tolerance_(tolerance), step_(step) {}

  void draw(const Rim& rim) {
    const Vec3 reach = Vec3::Constant(tolerance_);
    const Vec3 low = rim.from.cwiseMin(rim.to) - reach, high = rim.from.cwiseMax(rim.to) + reach;
    if ((low.array() > on_.box().high.array()).any() || (high.array() < on_.box().low.array()).any()) return;
    for (const std::size_t side : {0U, 1U}) draw_side(rim, side);
  }

 private:
  // Where this side of the rim lies on the surface and the other one does not, at this part of the way.
  std::optional<Foot> foot(const Rim& rim, std::size_t side, double part) const {
    const Vec3 place = (1 - part) * rim.from + part * rim.to;
    std::optional<Foot> found = on_.under(place, rim.normals[side], tolerance_);
    if (found && on_.under(place, rim.normals[1 - side], tolerance_)) return {};
    return found;
  }

  // Between a part of the way with a foot and one without, the last with one.
  double last_with_foot(const Rim& rim, std::size_t side, double with, double without) const {
    for (int i = 0; i < imprint_bisections; ++i) {
      const double middle = (with + without) / 2;
      (foot(rim, side, middle) ? with : without) = middle;
    }
    return with;
  }

  void draw_side(const Rim& rim, std::size_t side) {
    const double length = (rim.to - rim.from).norm();
    const auto steps = std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(length / step_)), 4, most_steps);
    std::optional<double> begin;
    double last = 0;
    for (std::size_t i = 0; i <= steps + 1; ++i) {
      const double part = static_cast<double>(i) / static_cast<double>(steps);
      if (i <= steps && foot(rim, side, part)) {
        if (!begin) begin = i == 0 ? 0 : last_with_foot(rim, side, part, part - 1 / static_cast<double>(steps));
        last = part;
        continue;
      }
      if (!begin) continue;
      const double end = i > steps ? 1 : last_with_foot(rim, side, last, part);
      if ((end - *begin) * length > tolerance_) draw_line(rim, side, *begin, end);
      begin.reset();
    }
  }

  void draw_line(const Rim& rim, std::size_t side, double begin, double end) {
    const Foot from = *foot(rim, side, begin), to = *foot(rim, side, end);
    const std::uint32_t a = surface_.insert(from.triangle, from.point, tolerance_);
    const std::uint32_t b = surface_.insert(to.triangle, to.point, tolerance_);
    walk(a, b, -rim.normals[side]);
  }

  // From vertex to vertex, splitting the edges between; ends early where the surface turns away.
  void walk(std::uint32_t at, std::uint32_t to, const Vec3& normal) {
    while (at != to && !surface_.has_edge(at, to)) {
      const std::optional<std::uint32_t> next = step_towards(at, to, normal);
      if (!next) return;
      at = *next;
    }
  }

  std::optional<std::uint32_t> step_towards(std::uint32_t at, std::uint32_t to, const Vec3& normal) {
    const Vec3 from = surface_.point(at), way = surface_.point(to) - from;
    const Vec3 ahead = (way - way.dot(normal) * normal).normalized(), across = normal.cross(ahead);
    for (const std::uint32_t f : surface_.around(at)) {
      if (on_.normal(surface_.origin(f)).dot(normal) < facing / 2) continue;
      const Triangle& t = surface_.triangle(f);
      const auto k = static_cast<std::size_t>(std::find(t.begin(), t.end(), at) - t.begin());
      const std::uint32_t u = t[(k + 1) % 3], w = t[(k + 2) % 3];
      const double right = across.dot(surface_.point(u) - from), left = across.dot(surface_.point(w) - from);
      if ((right < 0) == (left < 0)) continue;
      const Vec3 point = surface_.point(u) + right / (right - left) * (surface_.point(w) - surface_.point(u));
      if (ahead.dot(point - from) <= 0 || ahead.dot(point - from) > way.norm()) continue;
      for (const std::uint32_t v : {u, w})
        if ((surface_.point(v) - point).norm() <= tolerance_ && is_nearer(v, at, to)) return v;
      return surface_.split_edge(u, w, point);
    }
    return {};
  }

  bool is_nearer(std::uint32_t v, std::uint32_t than, std::uint32_t to) const {
    return (surface_.point(v) - surface_.point(to)).norm() < (surface_.point(than) - surface_.point(to)).norm();
  }

  SplitSurface& surface_;
  const FacingSurface& on_;
  double tolerance_, step_;
};

}  // namespace

void imprint_rims(SplitSurface& surface, const FacingSurface& facing_surface, const SurfaceMesh& other,
                  std::span<const std::uint32_t> triangles, double tolerance, double step) {
  Imprint imprint(surface, facing_surface, tolerance, step);
  for (const Rim& rim : find_rims(other, triangles)) imprint.draw(rim);
}

}  // namespace scan2fea
