#include "preproc/surface/enrichment/clear_surface.hpp"

#include "quality/self_intersections.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scan2fea {
namespace {

using Index = HalfedgeMesh::Index;

// 21 bits a coordinate, about the middle.
std::uint64_t key_of(std::int32_t x, std::int32_t y, std::int32_t z) {
  const auto part = [](std::int32_t i) { return static_cast<std::uint64_t>(i + (1 << 20)) & ((1U << 21) - 1); };
  return part(x) << 42 | part(y) << 21 | part(z);
}

bool boxes_apart(const std::vector<Vec3>& points, const Triangle& s, const Triangle& t) {
  const auto low = [&](const Triangle& f) { return points[f[0]].cwiseMin(points[f[1]]).cwiseMin(points[f[2]]).eval(); };
  const auto high = [&](const Triangle& f) {
    return points[f[0]].cwiseMax(points[f[1]]).cwiseMax(points[f[2]]).eval();
  };
  return (low(s).array() > high(t).array()).any() || (low(t).array() > high(s).array()).any();
}

}  // namespace

ClearSurface::ClearSurface(HalfedgeMesh& mesh, double cell) : mesh_(mesh), cell_(cell) {
  cells_.resize(mesh.face_slots());
  for (Index f = 0; f < mesh.face_slots(); ++f) {
    if (!mesh.is_face_alive(f)) continue;
    const Triangle t = mesh.triangle(f);
    const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    put(f, cells_of(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)));
  }
}

ClearSurface::Cells ClearSurface::cells_of(const Vec3& low, const Vec3& high) const {
  Cells cells;
  for (int i = 0; i < 3; ++i) {
    cells.low[i] = static_cast<std::int32_t>(std::floor(low[i] / cell_));
    cells.high[i] = static_cast<std::int32_t>(std::floor(high[i] / cell_));
  }
  return cells;
}

template <class Visit>
void ClearSurface::for_each_cell(const Cells& cells, Visit visit) const {
  for (std::int32_t x = cells.low[0]; x <= cells.high[0]; ++x)
    for (std::int32_t y = cells.low[1]; y <= cells.high[1]; ++y)
      for (std::int32_t z = cells.low[2]; z <= cells.high[2]; ++z) visit(key_of(x, y, z));
}

void ClearSurface::put(Index face, const Cells& cells) {
  if (face >= cells_.size()) cells_.resize(std::size_t{face} + 1);
  for_each_cell(cells_[face], [&](std::uint64_t key) { std::erase(faces_in_[key], face); });
  cells_[face] = cells;
  for_each_cell(cells, [&](std::uint64_t key) { faces_in_[key].push_back(face); });
}

void ClearSurface::put_star(Index v) {
  mesh_.for_each_outgoing(v, [&](Index h) {
    const Triangle t = mesh_.triangle(HalfedgeMesh::face(h));
    const Vec3 &a = mesh_.points[t[0]], &b = mesh_.points[t[1]], &c = mesh_.points[t[2]];
    put(HalfedgeMesh::face(h), cells_of(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)));
  });
}

bool ClearSurface::meets_others(const Triangle& t, Index face, Index without) const {
  const std::vector<Vec3>& p = mesh_.points;
  if (is_collinear(p, t)) return true;
  const Cells cells =
      cells_of(p[t[0]].cwiseMin(p[t[1]]).cwiseMin(p[t[2]]), p[t[0]].cwiseMax(p[t[1]]).cwiseMax(p[t[2]]));
  bool meets = false;
  for_each_cell(cells, [&](std::uint64_t key) {
    const auto found = faces_in_.find(key);
    if (meets || found == faces_in_.end()) return;
    for (const Index other : found->second) {
      if (other == face || other == without) continue;
      const Triangle u = mesh_.triangle(other);
      if (boxes_apart(p, t, u) || is_collinear(p, u)) continue;
      meets = faces_intersect(p, t, u);
      if (meets) return;
    }
  });
  return meets;
}

// Cosines of the angles between faces, at all edges of those of v.
std::vector<double> ClearSurface::bends_around(Index v) const {
  const auto normal = [&](Index h) { return mesh_.area_vector(HalfedgeMesh::face(h)).normalized(); };
  std::vector<double> cosines;
  mesh_.for_each_outgoing(v, [&](Index h) {
    for (const Index edge : {h, HalfedgeMesh::next(h)})
      if (!mesh_.is_border(edge)) cosines.push_back(normal(edge).dot(normal(mesh_.opposite(edge))));
  });
  return cosines;
}

bool ClearSurface::move(Index v, const Vec3& place) {
  const Vec3 before = mesh_.points[v];
  if (place == before) return true;
  mesh_.points[v] = place;
  // No nearer to a neighbour than a fiftieth of an edge, where it was not before: edges of no length help nobody.
  constexpr double nearest = 0.02;
  bool meets = false;
  mesh_.for_each_neighbour(v, [&](Index w) {
    const double distance = (place - mesh_.points[w]).norm();
    meets = meets || (distance < nearest * cell_ && distance < (before - mesh_.points[w]).norm());
  });
  mesh_.for_each_outgoing(v, [&](Index h) {
    const Index f = HalfedgeMesh::face(h);
    meets = meets || meets_others(mesh_.triangle(f), f, f);
  });
  if (meets)
    mesh_.points[v] = before;
  else
    put_star(v);
  return !meets;
}

bool ClearSurface::move_without_fold(Index v, const Vec3& place) {
  const std::vector<double> before = bends_around(v);
  const Vec3 from = std::exchange(mesh_.points[v], place);
  const std::vector<double> after = bends_around(v);
  mesh_.points[v] = from;
  for (std::size_t i = 0; i < after.size(); ++i)
    if (after[i] < std::min(fold_cosine, before[i])) return false;
  return move(v, place);
}

bool ClearSurface::clear_to_flip(Index h) {
  const Index o = mesh_.opposite(h), f = HalfedgeMesh::face(h), g = HalfedgeMesh::face(o);
  const Index a = mesh_.origin(h), b = mesh_.target(h);
  const Index c = mesh_.origin(HalfedgeMesh::prev(h)), d = mesh_.origin(HalfedgeMesh::prev(o));
  if (meets_others({d, c, a}, f, g) || meets_others({c, d, b}, f, g)) return false;
  const std::vector<Vec3>& p = mesh_.points;
  const Cells cells =
      cells_of(p[a].cwiseMin(p[b]).cwiseMin(p[c]).cwiseMin(p[d]), p[a].cwiseMax(p[b]).cwiseMax(p[c]).cwiseMax(p[d]));
  put(f, cells);
  put(g, cells);
  return true;
}

void ClearSurface::vertex_added(Index v) {
  put_star(v);
}

}  // namespace scan2fea
