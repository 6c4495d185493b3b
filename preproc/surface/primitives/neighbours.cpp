#include "preproc/surface/primitives/neighbours.hpp"

#include "preproc/mesh/face_neighbours.hpp"
#include "preproc/surface/kernel/point_neighbours.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace scan2fea {
namespace {

// Cosine of 102 degrees: the sides of a right-angled edge see each other, those of a wall do not.
constexpr double least_cosine = -0.2;

// Per point the `count` met first, by distance in space, when spreading from it: visit_next(point, put) calls put for
// those that adjoin.
template <class VisitNext>
Neighbours spread(const std::vector<Vec3>& points, std::size_t count, VisitNext visit_next) {
  std::vector<std::uint32_t> met_by(points.size(), ~std::uint32_t{0});
  using Entry = std::pair<double, std::uint32_t>;
  std::vector<Entry> queue;
  Neighbours neighbours;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    queue.clear();
    met_by[i] = i;
    const auto put = [&](std::uint32_t w) {
      if (met_by[w] == i) return;
      met_by[w] = i;
      queue.emplace_back((points[w] - points[i]).squaredNorm(), w);
      std::push_heap(queue.begin(), queue.end(), std::greater<>());
    };
    visit_next(i, put);
    for (std::size_t taken = 0; taken < count && !queue.empty(); ++taken) {
      std::pop_heap(queue.begin(), queue.end(), std::greater<>());
      const std::uint32_t v = queue.back().second;
      queue.pop_back();
      neighbours.all.push_back(v);
      visit_next(v, put);
    }
    neighbours.first.push_back(neighbours.all.size());
  }
  return neighbours;
}

}  // namespace

Neighbours nearest_in_space(const std::vector<Vec3>& points, const std::vector<Vec3>& normals, std::size_t count) {
  const PointNeighbours tree(points);
  // Where a wall is as thin as the spacing, half of those met are its other side's.
  std::vector<PointNeighbours::Neighbour> met((normals.empty() ? count : 2 * count) + 1);
  Neighbours neighbours;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::size_t taken = 0;
    for (const auto& [point, distance] : tree.nearest(points[i], met)) {
      if (point == i || (!normals.empty() && normals[point].dot(normals[i]) < least_cosine)) continue;
      neighbours.all.push_back(point);
      if (++taken == count) break;
    }
    neighbours.first.push_back(neighbours.all.size());
  }
  return neighbours;
}

Neighbours nearest_on_surface(const SurfaceMesh& mesh, std::size_t count) {
  const VertexStars stars(mesh);
  return spread(mesh.vertices, count, [&](std::uint32_t v, auto put) {
    for (const std::uint32_t corner : stars.corners(v))
      for (const std::uint32_t w : mesh.triangles[corner / 3]) put(w);
  });
}

Neighbours neighbours_within(const Neighbours& all, const std::vector<Vec3>& points, const std::vector<bool>& within,
                             std::size_t count) {
  return spread(points, count, [&](std::uint32_t v, auto put) {
    if (!within[v]) return;
    for (const std::uint32_t w : all.of(v))
      if (within[w]) put(w);
  });
}

}  // namespace scan2fea
