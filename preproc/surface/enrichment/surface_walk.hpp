// Finding one's way on a surface along its edges, without a search structure in space: neighbours within a distance,
// and the point that lies in a direction. The other side of a thin wall is far away on the surface, and so never met;
// and the surface may be refined between two searches.
#pragma once

#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace scan2fea {

// A point of the surface: weights of the face's corners, which sum to 1.
struct SurfacePoint {
  HalfedgeMesh::Index face = HalfedgeMesh::none;
  Vec3 weights = Vec3::Zero();
};

Vec3 position(const HalfedgeMesh& mesh, const SurfacePoint& point);

// The end of the straightest path of the given length (model units, along the surface) that leaves v in `direction`, a
// unit vector normal to `normal`, the unit normal at v. Nothing where the path meets a border or a face without area.
// O(faces crossed).
std::optional<SurfacePoint> walk_straight(const HalfedgeMesh& mesh, HalfedgeMesh::Index v, const Vec3& normal,
                                          const Vec3& direction, double length);

// Visits vertices by growing distance (in space) from a point, spreading along edges from given vertices.
class NearestOnSurface {
 public:
  using Index = HalfedgeMesh::Index;

  explicit NearestOnSurface(const HalfedgeMesh& mesh) : mesh_(mesh) {}

  // Calls visit(vertex, squared distance) -> bool until it returns false or no vertex is left within `radius`.
  // Vertices for which pass(vertex) is false are neither visited nor crossed. Seeds beyond the radius are crossed.
  template <class Pass, class Visit>
  void search(std::span<const Index> seeds, const Vec3& centre, double radius, Pass pass, Visit visit) {
    seen_.resize(mesh_.vertex_slots(), 0);
    if (++round_ == 0) {
      seen_.assign(seen_.size(), 0);
      round_ = 1;
    }
    queue_.clear();
    const double limit = radius * radius;
    const auto put = [&](Index v) {
      seen_[v] = round_;
      queue_.push_back({(mesh_.points[v] - centre).squaredNorm(), v});
      std::push_heap(queue_.begin(), queue_.end());
    };
    for (const Index v : seeds)
      if (seen_[v] != round_ && pass(v)) put(v);
    while (!queue_.empty()) {
      std::pop_heap(queue_.begin(), queue_.end());
      const auto [distance, v] = queue_.back();
      queue_.pop_back();
      if (distance <= limit && !visit(v, distance)) return;
      mesh_.for_each_neighbour(v, [&](Index w) {
        if (seen_[w] != round_ && (mesh_.points[w] - centre).squaredNorm() <= limit && pass(w)) put(w);
      });
    }
  }

 private:
  struct Entry {
    double distance;
    Index vertex;
    // Reversed: the standard heap has its largest in front. Ties by index.
    bool operator<(const Entry& other) const {
      return distance > other.distance || (distance == other.distance && vertex > other.vertex);
    }
  };

  const HalfedgeMesh& mesh_;
  std::vector<std::uint32_t> seen_;  // the last search that met the vertex
  std::uint32_t round_ = 0;
  std::vector<Entry> queue_;
};

}  // namespace scan2fea
