#include "preproc/surface/kernel/clear_moves.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/face_boxes.hpp"
#include "quality/self_intersections.hpp"
#include "quality/triangle_measures.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace scan2fea {
namespace {

constexpr double smallest_turn_cosine = 0.5;
// 1 / eta of a face that a move may leave, unless it was worse before: about 12 degrees.
constexpr double least_quality = 0.35;

class ClearMover {
 public:
  explicit ClearMover(SurfaceMesh& mesh) : mesh_(mesh), stars_(mesh), boxes_(mesh) {}

  // Whether v may be at `place`; it then is.
  bool try_move(std::uint32_t v, const Vec3& place) {
    const Vec3 before = mesh_.vertices[v];
    const std::span<const std::uint32_t> corners = stars_.corners(v);
    for (const std::uint32_t corner : corners)
      if (!keeps_shape(corner, place)) return false;
    mesh_.vertices[v] = place;
    if (!is_clear(corners)) {
      mesh_.vertices[v] = before;
      return false;
    }
    for (const std::uint32_t corner : corners) boxes_.set(corner / 3, box_of_face(mesh_, corner / 3));
    return true;
  }

 private:
  bool keeps_shape(std::uint32_t corner, const Vec3& place) const {
    const Triangle& t = mesh_.triangles[corner / 3];
    const Vec3& p = mesh_.vertices[t[corner % 3]];
    const Vec3& a = mesh_.vertices[t[(corner + 1) % 3]];
    const Vec3& b = mesh_.vertices[t[(corner + 2) % 3]];
    return keeps_shape(p, place, a, b);
  }

  static bool keeps_shape(const Vec3& p, const Vec3& place, const Vec3& a, const Vec3& b) {
    const Vec3 before = (a - p).cross(b - p), after = (a - place).cross(b - place);
    if (!(after.dot(before) > smallest_turn_cosine * after.norm() * before.norm())) return false;
    const double quality = 1 / eta(place, a, b);
    return quality >= least_quality || quality >= 1 / eta(p, a, b);
  }

  // Whether no face of the star meets another. The star's own boxes are still those of before the move.
  bool is_clear(std::span<const std::uint32_t> corners) const {
    bool clear = true;
    const auto test = [&](std::uint32_t f, std::uint32_t g) {
      if (clear && faces_intersect(mesh_.vertices, mesh_.triangles[f], mesh_.triangles[g])) clear = false;
    };
    const auto in_star = [&](std::uint32_t f) {
      return std::any_of(corners.begin(), corners.end(), [&](std::uint32_t corner) { return corner / 3 == f; });
    };
    for (std::size_t i = 0; i < corners.size() && clear; ++i) {
      const std::uint32_t f = corners[i] / 3;
      if (is_collinear(mesh_.vertices, mesh_.triangles[f])) return false;
      for (std::size_t j = 0; j < i; ++j) test(f, corners[j] / 3);
      boxes_.for_each_overlap(box_of_face(mesh_, f), [&](std::uint32_t g) {
        if (!in_star(g)) test(f, g);
      });
    }
    return clear;
  }

  SurfaceMesh& mesh_;
  VertexStars stars_;
  FaceBoxes boxes_;
};

}  // namespace

ClearMoves move_clear(SurfaceMesh& mesh, const std::vector<Vec3>& targets, int sweeps) {
  constexpr std::array<double, 3> parts{1, 0.5, 0.25};
  ClearMover mover(mesh);
  std::vector<bool> arrived(mesh.vertices.size(), false);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      if (arrived[v]) continue;
      const Vec3 from = mesh.vertices[v], way = targets[v] - from;
      if (way.isZero(0)) {
        arrived[v] = true;
        continue;
      }
      for (const double part : parts) {
        if (!mover.try_move(v, from + part * way)) continue;
        arrived[v] = part == 1;
        break;
      }
    }
  }
  return {.held = static_cast<std::size_t>(std::count(arrived.begin(), arrived.end(), false))};
}

}  // namespace scan2fea
