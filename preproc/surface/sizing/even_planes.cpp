#include "preproc/surface/sizing/even_planes.hpp"

#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// Cosine between normals; cuts leave needles on curved surfaces, whose corners lie in any plane.
constexpr double alike = 0.9999;

class Planes {
 public:
  Planes(const SurfaceMesh& mesh, double longest, double rounding)
      : mesh_(mesh), longest_(longest), rounding_(rounding) {}

  SurfaceMesh run() {
    constexpr int most_passes = 30;
    for (Index h = 0; h < 3 * mesh_.face_slots(); ++h) open_.push_back(h);
    flip_open();
    for (int pass = 0; pass < most_passes; ++pass) {
      const std::vector<Index> long_edges = find_long_edges();
      if (long_edges.empty()) break;
      for (const Index h : long_edges) {
        if (!is_long(h)) continue;  // since another one was halved
        const Vec3 middle = (mesh_.points[mesh_.origin(h)] + mesh_.points[mesh_.target(h)]) / 2;
        const Index v = mesh_.split_edge(h, middle);
        mesh_.for_each_outgoing(v, [&](Index out) { open_.push_back(HalfedgeMesh::next(out)); });
      }
      flip_open();
    }
    return mesh_.to_surface();
  }

 private:
  double length(Index h) const { return (mesh_.points[mesh_.origin(h)] - mesh_.points[mesh_.target(h)]).norm(); }

  // Of an edge, the half with the smaller number.
  std::vector<Index> find_long_edges() const {
    std::vector<Index> edges;
    for (Index h = 0; h < 3 * mesh_.face_slots(); ++h)
      if (mesh_.opposite(h) > h && is_long(h)) edges.push_back(h);
    std::ranges::stable_sort(edges, std::greater(), [&](Index h) { return length(h); });
    return edges;
  }

  // A border's long edge keeps long ones beside it.
  bool is_long(Index h) const {
    const double own = length(h);
    if (own <= longest_ || !is_in_plane(h)) return false;
    for (const Index of_face : {h, mesh_.opposite(h)})
      for (const Index other : {HalfedgeMesh::next(of_face), HalfedgeMesh::prev(of_face)})
        if (mesh_.is_border(other) && length(other) >= own) return false;
    return true;
  }

  bool is_in_plane(Index h) const {
    const Index o = mesh_.opposite(h);
    if (o == HalfedgeMesh::none) return false;
    const Vec3 first = mesh_.area_vector(HalfedgeMesh::face(h)), second = mesh_.area_vector(HalfedgeMesh::face(o));
    if (!(first.dot(second) > alike * first.norm() * second.norm())) return false;
    const bool first_is_larger = first.squaredNorm() >= second.squaredNorm();
    const Vec3& normal = first_is_larger ? first : second;
    const Vec3& apex = mesh_.points[mesh_.origin(HalfedgeMesh::prev(first_is_larger ? o : h))];
    return std::abs(normal.normalized().dot(apex - mesh_.points[mesh_.origin(h)])) <= rounding_;
  }

  void flip_open() {
    // Each flip makes the smallest angles around larger; rounding must not let two of them undo one another for ever.
    std::size_t left = 1000 + 40 * 3 * mesh_.face_slots() + mesh_.face_slots() * mesh_.face_slots() / 4;
    while (!open_.empty() && left > 0) {
      const Index h = open_.back();
      open_.pop_back();
      if (!gains_by_flip(h)) continue;
      --left;
      mesh_.flip(h);
      const Index o = mesh_.opposite(h);
      for (const Index around :
           {HalfedgeMesh::next(h), HalfedgeMesh::prev(h), HalfedgeMesh::next(o), HalfedgeMesh::prev(o)})
        open_.push_back(around);
    }
    open_.clear();
  }

  bool gains_by_flip(Index h) const {
    const Index o = mesh_.opposite(h);
    if (o == HalfedgeMesh::none || !is_in_plane(h) || !mesh_.can_flip(h)) return false;
    const Vec3 &a = mesh_.points[mesh_.origin(h)], &b = mesh_.points[mesh_.target(h)],
               &c = mesh_.points[mesh_.origin(HalfedgeMesh::prev(h))],
               &d = mesh_.points[mesh_.origin(HalfedgeMesh::prev(o))];
    const Vec3 normal = mesh_.area_vector(HalfedgeMesh::face(h)) + mesh_.area_vector(HalfedgeMesh::face(o));
    const double twice = normal.norm();
    // Both new triangles have an area.
    constexpr double least = 1e-9;
    const Vec3 first = (d - c).cross(b - c), second = (a - c).cross(d - c);
    if (first.dot(normal) <= least * twice * twice || second.dot(normal) <= least * twice * twice) return false;
    const auto cotangent = [](const Vec3& at, const Vec3& p, const Vec3& q) {
      return (p - at).dot(q - at) / std::max((p - at).cross(q - at).norm(), 1e-300);
    };
    return cotangent(c, a, b) + cotangent(d, a, b) < -1e-9;
  }

  HalfedgeMesh mesh_;
  double longest_, rounding_;
  std::vector<Index> open_;
};

}  // namespace

SurfaceMesh with_even_planes(const SurfaceMesh& mesh, double longest, double rounding) {
  return Planes(mesh, longest, rounding).run();
}

}  // namespace scan2fea
