#include "quality/face_blocks.hpp"

#include "preproc/mesh/morton_code.hpp"
#include "preproc/mesh/numbers.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <bit>
#include <utility>

namespace scan2fea {
namespace {

using Range = tbb::blocked_range<std::size_t>;

constexpr double cells_per_axis = (1 << morton_bits) - 1;

}  // namespace

BoundingBox box_of_face(const std::vector<Vec3>& points, const Triangle& face) {
  const Vec3 &a = points[face[0]], &b = points[face[1]], &c = points[face[2]];
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

BoundingBox box_of_face(const SurfaceMesh& mesh, std::uint32_t face) {
  return box_of_face(mesh.vertices, mesh.triangles[face]);
}

FaceBlocks::FaceBlocks(const SurfaceMesh& mesh) : order_(mesh.triangles.size()) {
  const std::size_t n = mesh.triangles.size();
  const BoundingBox whole = bounding_box(mesh.vertices);
  const double extent = (whole.high - whole.low).maxCoeff();
  const double scale = extent > 0 ? cells_per_axis / extent : 0;
  {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(n);
    tbb::parallel_for(Range(0, n, 4096), [&](const Range& range) {
      for (std::size_t f = range.begin(); f < range.end(); ++f) {
        const Triangle& t = mesh.triangles[f];
        const Vec3 centre = centroid(mesh, t);
        const Vec3 cell = scale * (centre - whole.low);
        keys[f] = {morton_code(static_cast<std::uint64_t>(cell.x()), static_cast<std::uint64_t>(cell.y()),
                               static_cast<std::uint64_t>(cell.z())),
                   static_cast<std::uint32_t>(f)};
      }
    });
    tbb::parallel_sort(keys.begin(), keys.end());  // no two are equal, so there is one order
    for (std::size_t i = 0; i < n; ++i) order_[i] = keys[i].second;
  }
  leaves_ = std::bit_ceil(std::max<std::size_t>(1, count()));
  nodes_.assign(2 * leaves_, {Vec3::Constant(infinity), Vec3::Constant(-infinity)});
  const auto unite = [](BoundingBox& box, const BoundingBox& other) {
    box.low = box.low.cwiseMin(other.low);
    box.high = box.high.cwiseMax(other.high);
  };
  tbb::parallel_for(Range(0, count(), 1024), [&](const Range& range) {
    for (std::size_t b = range.begin(); b < range.end(); ++b)
      for (const std::uint32_t f : faces(b)) unite(nodes_[leaves_ + b], box_of_face(mesh, f));
  });
  for (std::size_t node = leaves_; node-- > 1;) {
    unite(nodes_[node], nodes_[2 * node]);
    unite(nodes_[node], nodes_[2 * node + 1]);
  }
}

}  // namespace scan2fea
