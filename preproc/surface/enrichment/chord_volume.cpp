#include "preproc/surface/enrichment/chord_volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

class ChordVolume {
 public:
  ChordVolume(const HalfedgeMesh& mesh, const std::vector<bool>& free, const std::vector<bool>& creases)
      : mesh_(mesh), creases_(creases), free_(free), normal_(mesh.vertex_slots(), Vec3::Zero()) {
    for (Index v = 0; v < free_.size(); ++v)
      free_[v] = free_[v] && mesh.is_alive(v) && !mesh.is_border_vertex(v) && !is_crease(v);
    for_each_face([&](const Triangle& t, const Vec3& area) {
      for (const Index v : t) normal_[v] += area;
    });
    for (Vec3& n : normal_) n.normalize();
  }

  std::vector<Vec3> places() const {
    std::vector<double> volume(mesh_.vertex_slots(), 0.0), area(volume);
    for_each_face([&](const Triangle& t, const Vec3& area_vector) {
      const double own = area_vector.norm() / 2;
      const auto movable = std::ranges::count_if(t, [&](Index v) { return free_[v]; });
      for (const Index v : t) {
        area[v] += own / 3;
        if (free_[v]) volume[v] += own * mean_height(t) / static_cast<double>(movable);
      }
    });
    std::vector<Vec3> places = mesh_.points;
    for (Index v = 0; v < places.size(); ++v)
      if (free_[v] && area[v] > 0) places[v] += std::clamp(volume[v] / area[v], -most(v), most(v)) * normal_[v];
    return places;
  }

 private:
  template <class Visit>
  void for_each_face(const Visit& visit) const {
    for (Index f = 0; f < mesh_.face_slots(); ++f)
      if (mesh_.is_face_alive(f)) visit(mesh_.triangle(f), mesh_.area_vector(f));
  }

  bool is_crease(Index v) const { return !creases_.empty() && creases_[v]; }

  // In the middle of an edge, of the parabola between its ends. A half circle has a quarter of its chord.
  double height(Index a, Index b) const {
    if (is_crease(a) || is_crease(b)) return 0;
    return (normal_[b] - normal_[a]).dot(mesh_.points[b] - mesh_.points[a]) / 8;
  }

  // A quadratic triangle that is zero at its corners has the mean of the heights in the middles of its edges.
  double mean_height(const Triangle& t) const {
    return (height(t[0], t[1]) + height(t[1], t[2]) + height(t[2], t[0])) / 3;
  }

  double most(Index v) const {
    double highest = 0;
    mesh_.for_each_neighbour(v, [&](Index w) { highest = std::max(highest, std::abs(height(v, w))); });
    return highest;
  }

  const HalfedgeMesh& mesh_;
  const std::vector<bool>& creases_;
  std::vector<bool> free_;
  std::vector<Vec3> normal_;
};

}  // namespace

std::vector<Vec3> with_chord_volume(const HalfedgeMesh& mesh, const std::vector<bool>& free,
                                    const std::vector<bool>& creases) {
  return ChordVolume(mesh, free, creases).places();
}

}  // namespace scan2fea
