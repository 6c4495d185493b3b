#include "preproc/surface/enrichment/unfold.hpp"

#include <algorithm>
#include <array>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

constexpr double least_gain = 0.2;  // of the cosine, by a turn

class Unfolder {
 public:
  Unfolder(HalfedgeMesh& mesh, const SurfaceLabels& labels, ClearSurface& clear)
      : mesh_(mesh), labels_(labels), clear_(clear) {}

  std::size_t run() {
    constexpr int most_passes = 5;
    std::size_t all = 0;
    for (int pass = 0; pass < most_passes; ++pass) {
      std::size_t turned = 0;
      for (Index h = 0; h < 3 * mesh_.face_slots(); ++h) {
        if (!mesh_.is_face_alive(HalfedgeMesh::face(h)) || mesh_.is_border(h) || h > mesh_.opposite(h)) continue;
        if (!(bend(h) < fold_cosine)) continue;
        // The edge itself, or one beside it whose turn opens it.
        const Index o = mesh_.opposite(h);
        for (const Index e :
             {h, HalfedgeMesh::next(h), HalfedgeMesh::prev(h), HalfedgeMesh::next(o), HalfedgeMesh::prev(o)}) {
          if (!is_better_turned(e) || !mesh_.can_flip(e) || !clear_.clear_to_flip(e)) continue;
          mesh_.flip(e);
          ++turned;
          break;
        }
      }
      all += turned;
      if (turned == 0) break;
    }
    return all;
  }

 private:
  Vec3 normal(Index a, Index b, Index c) const {
    const std::vector<Vec3>& p = mesh_.points;
    return (p[b] - p[a]).cross(p[c] - p[a]).normalized();
  }
  Vec3 normal(Index h) const { return mesh_.area_vector(HalfedgeMesh::face(h)).normalized(); }
  double bend(Index h) const { return mesh_.is_border(h) ? 1 : normal(h).dot(normal(mesh_.opposite(h))); }

  bool is_better_turned(Index h) const {
    if (mesh_.is_border(h) || labels_.is_crease(h)) return false;
    const Index o = mesh_.opposite(h);
    const Index a = mesh_.origin(h), b = mesh_.target(h);
    const Index c = mesh_.origin(HalfedgeMesh::prev(h)), d = mesh_.origin(HalfedgeMesh::prev(o));
    const auto beyond = [&](Index side) {
      return mesh_.is_border(side) ? Vec3(Vec3::Zero()) : normal(mesh_.opposite(side));
    };
    const Vec3 bc = beyond(HalfedgeMesh::next(h)), ca = beyond(HalfedgeMesh::prev(h));
    const Vec3 ad = beyond(HalfedgeMesh::next(o)), db = beyond(HalfedgeMesh::prev(o));
    const auto sharpest = [](const Vec3& m, const Vec3& n, const std::array<Vec3, 2>& of_m,
                             const std::array<Vec3, 2>& of_n) {
      return std::min({m.dot(n), m.dot(of_m[0]), m.dot(of_m[1]), n.dot(of_n[0]), n.dot(of_n[1])});
    };
    const double before = sharpest(normal(h), normal(o), {bc, ca}, {ad, db});
    const double after = sharpest(normal(d, c, a), normal(c, d, b), {ca, ad}, {db, bc});
    return after > before + least_gain;
  }

  HalfedgeMesh& mesh_;
  const SurfaceLabels& labels_;
  ClearSurface& clear_;
};

}  // namespace

std::size_t unfold(HalfedgeMesh& mesh, const SurfaceLabels& labels, ClearSurface& clear) {
  return Unfolder(mesh, labels, clear).run();
}

}  // namespace scan2fea
