#include "preproc/surface/enrichment/curved_volume.hpp"

#include "preproc/surface/enrichment/side_normals.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// What lies between the flat triangles and the curved surface through their corners.
class CutOff {
 public:
  explicit CutOff(const HalfedgeMesh& mesh)
      : mesh_(mesh), normals_(mesh, CornerWeight::ball), of_face_(mesh.face_slots(), 0.0) {
    for (Index f = 0; f < mesh.face_slots(); ++f)
      if (mesh.is_face_alive(f)) of_face_[f] = mesh.area_vector(f).norm() / 2 * mean_height(f);
  }

  const Vec3& normal(Index v) const { return normals_.mean(v); }
  double of_face(Index f) const { return of_face_[f]; }

  double sum() const {
    double sum = 0;
    for (const double volume : of_face_) sum += volume;
    return sum;
  }
  double sum_of_sizes() const {
    double sum = 0;
    for (const double volume : of_face_) sum += std::abs(volume);
    return sum;
  }

 private:
  // A quadratic triangle that is zero at its corners has the mean of the heights in the middles of its edges. A half
  // circle has a quarter of its chord.
  double mean_height(Index f) const {
    const Triangle t = mesh_.triangle(f);
    const Vec3 out = mesh_.area_vector(f);
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = t[k], b = t[(k + 1) % 3];
      sum += (normals_.facing(b, out) - normals_.facing(a, out)).dot(mesh_.points[b] - mesh_.points[a]) / 8;
    }
    return sum / 3;
  }

  const HalfedgeMesh& mesh_;
  SideNormals normals_;
  std::vector<double> of_face_;
};

// Of the pyramids with their tips in one vertex, so that digits are not lost far from the origin: in one of the border,
// which stays where it is.
double flat_volume(const HalfedgeMesh& mesh) {
  Index tip = 0;
  while (tip < mesh.vertex_slots() && !(mesh.is_alive(tip) && mesh.is_border_vertex(tip))) ++tip;
  const Vec3 from = mesh.points[tip < mesh.vertex_slots() ? tip : 0];
  double sum = 0;
  for (Index f = 0; f < mesh.face_slots(); ++f) {
    if (!mesh.is_face_alive(f)) continue;
    const Triangle t = mesh.triangle(f);
    sum += (mesh.points[t[0]] - from).dot(mesh.area_vector(f)) / 6;
  }
  return sum;
}

// Normals of single vertices turn with noise: what one has it shares with those beside it.
std::vector<double> shared(const HalfedgeMesh& mesh, const std::vector<double>& volume, const auto& is_movable) {
  std::vector<double> result(volume.size(), 0.0);
  for (Index v = 0; v < volume.size(); ++v) {
    if (!is_movable(v)) continue;
    int count = 1;
    mesh.for_each_neighbour(v, [&](Index w) { count += is_movable(w); });
    result[v] += volume[v] / count;
    mesh.for_each_neighbour(v, [&](Index w) {
      if (is_movable(w)) result[w] += volume[v] / count;
    });
  }
  return result;
}

}  // namespace

double curved_volume(const HalfedgeMesh& mesh) {
  return flat_volume(mesh) + CutOff(mesh).sum();
}

bool may_be_finer(const HalfedgeMesh& surface, const HalfedgeMesh& scan) {
  // Where all is plane nothing is cut off.
  constexpr double allowance = 2, of_rounding = 1e-6;
  const double before = flat_volume(scan);
  return std::abs(flat_volume(surface) - before) <=
         allowance * CutOff(scan).sum_of_sizes() + of_rounding * std::abs(before);
}

std::vector<Vec3> with_curved_volume(const HalfedgeMesh& mesh, const std::vector<bool>& free, double volume) {
  const CutOff cut_off(mesh);
  const auto is_movable = [&](Index v) { return free[v] && mesh.is_alive(v) && !mesh.is_border_vertex(v); };
  std::vector<double> share(mesh.vertex_slots(), 0.0), area(share);
  for (Index f = 0; f < mesh.face_slots(); ++f) {
    if (!mesh.is_face_alive(f)) continue;
    const Triangle t = mesh.triangle(f);
    const auto movable = std::ranges::count_if(t, is_movable);
    for (const Index v : t) {
      area[v] += mesh.area_vector(f).norm() / 6;
      if (is_movable(v)) share[v] += cut_off.of_face(f) / static_cast<double>(movable);
    }
  }
  for (int round = 0; round < 2; ++round) share = shared(mesh, share, is_movable);
  std::vector<Vec3> places = mesh.points;
  const double sizes = cut_off.sum_of_sizes();
  if (!(sizes > 0)) return places;
  const double own = cut_off.sum(), lacking = volume - flat_volume(mesh) - own;
  const double times = std::max(0.0, 1 + (own > 0 ? lacking : -lacking) / sizes);
  for (Index v = 0; v < places.size(); ++v)
    if (share[v] != 0 && area[v] > 0) places[v] += times * share[v] / area[v] * cut_off.normal(v);
  return places;
}

}  // namespace scan2fea
