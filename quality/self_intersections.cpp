#include "quality/self_intersections.hpp"

#include "quality/triangle_tree.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace scan2fea {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Corners = std::array<Point, 3>;

Corners corners_of(const SurfaceMesh& mesh, const Triangle& t) {
  const auto point = [&](std::uint32_t v) {
    const Vec3& p = mesh.vertices[v];
    return Point(p.x(), p.y(), p.z());
  };
  return {point(t[0]), point(t[1]), point(t[2])};
}

BoundingBox box_of(const SurfaceMesh& mesh, const Triangle& t) {
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

// Exact, but for most faces decided by one cross product: rounding cannot make more of a zero area than the bound.
bool is_collinear(const SurfaceMesh& mesh, const Triangle& t) {
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const Vec3 ab = b - a, ac = c - a;
  if (ab.cross(ac).squaredNorm() > 1e-24 * ab.squaredNorm() * ac.squaredNorm()) return false;
  const Corners p = corners_of(mesh, t);
  return CGAL::collinear(p[0], p[1], p[2]);
}

// Whether a plane through the triangle, or one of its edges' walls along a coordinate axis, has all `points` strictly
// beyond it. Such a plane proves that their hull does not meet the triangle, at a fraction of the full test's price;
// on a scan nearly every pair is settled by it.
template <std::size_t N>
bool is_separated(const std::array<Point, N>& points, const Corners& t) {
  const auto all = [&](auto beyond) { return std::all_of(points.begin(), points.end(), beyond); };
  const CGAL::Orientation side = CGAL::orientation(t[0], t[1], t[2], points[0]);
  if (side != CGAL::COPLANAR &&
      all([&](const Point& p) { return &p == &points[0] || CGAL::orientation(t[0], t[1], t[2], p) == side; }))
    return true;

  // Projected along the axis in which the triangle's area vector is largest; any axis would be correct.
  const Kernel::Vector_3 normal = CGAL::cross_product(t[1] - t[0], t[2] - t[0]);
  int drop = std::abs(normal.x()) > std::abs(normal.y()) ? 0 : 1;
  if (std::abs(normal.z()) > std::abs(normal[drop])) drop = 2;
  const auto flat = [&](const Point& p) { return Kernel::Point_2(p[(drop + 1) % 3], p[(drop + 2) % 3]); };
  const std::array<Kernel::Point_2, 3> corner{flat(t[0]), flat(t[1]), flat(t[2])};
  const CGAL::Orientation turn = CGAL::orientation(corner[0], corner[1], corner[2]);
  if (turn == CGAL::COLLINEAR) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& from = corner[k];
    const auto& to = corner[(k + 1) % 3];
    if (all([&](const Point& p) { return CGAL::orientation(from, to, flat(p)) == -turn; })) return true;
  }
  return false;
}

// Corner indices of two faces that name the same vertex.
struct SharedVertices {
  std::size_t count = 0;
  std::size_t of_first = 0, of_second = 0;  // sums of the corner indices, so that with two shared 3 - sum is the third
};

SharedVertices shared_vertices(const Triangle& s, const Triangle& t) {
  SharedVertices shared;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (s[i] == t[j]) {
        ++shared.count;
        shared.of_first += i;
        shared.of_second += j;
      }
  return shared;
}

bool faces_intersect(const SurfaceMesh& mesh, const Triangle& s, const Triangle& t) {
  const SharedVertices shared = shared_vertices(s, t);
  if (shared.count == 3) return true;
  const Corners p = corners_of(mesh, s), q = corners_of(mesh, t);

  if (shared.count == 2) {  // folded flat onto one another?
    const std::size_t i = 3 - shared.of_first, j = 3 - shared.of_second;
    const Point &from = p[(i + 1) % 3], &to = p[(i + 2) % 3];
    return CGAL::orientation(from, to, p[i], q[j]) == CGAL::COPLANAR &&
           CGAL::coplanar_orientation(from, to, p[i], q[j]) == CGAL::POSITIVE;
  }
  const Kernel::Triangle_3 first(p[0], p[1], p[2]), second(q[0], q[1], q[2]);
  if (shared.count == 1) {
    const std::size_t i = shared.of_first, j = shared.of_second;
    const std::array<Point, 2> opposite_p{p[(i + 1) % 3], p[(i + 2) % 3]};
    const std::array<Point, 2> opposite_q{q[(j + 1) % 3], q[(j + 2) % 3]};
    return (!is_separated(opposite_q, p) &&
            CGAL::do_intersect(first, Kernel::Segment_3(opposite_q[0], opposite_q[1]))) ||
           (!is_separated(opposite_p, q) &&
            CGAL::do_intersect(second, Kernel::Segment_3(opposite_p[0], opposite_p[1])));
  }
  return !is_separated(q, p) && !is_separated(p, q) && CGAL::do_intersect(first, second);
}

// Pairs of a face of the mesh and one of `faces`. `named` tells of every face whether it is one of these.
std::vector<FacePair> find_pairs(const SurfaceMesh& mesh, std::span<const std::uint32_t> faces,
                                 const std::vector<char>& named) {
  std::vector<FacePair> pairs;
  std::vector<std::uint32_t> solid;
  for (const std::uint32_t f : faces) {
    if (is_collinear(mesh, mesh.triangles[f]))
      pairs.push_back({f, f});
    else
      solid.push_back(f);
  }
  if (solid.empty()) return pairs;
  const TriangleTree tree(mesh, solid);

  // Fixed blocks, gathered in their order: the same result for any number of threads.
  constexpr std::size_t block_size = 512;
  std::vector<std::vector<FacePair>> found((mesh.triangles.size() + block_size - 1) / block_size);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t block) {
    const std::size_t end = std::min(mesh.triangles.size(), (block + 1) * block_size);
    for (std::size_t i = block * block_size; i < end; ++i) {
      const auto f = static_cast<std::uint32_t>(i);
      const Triangle& t = mesh.triangles[f];
      if (is_collinear(mesh, t)) continue;
      tree.for_each_overlap(box_of(mesh, t), [&](std::uint32_t other) {
        if (named[f] != 0 && other <= f) return;  // that pair is found from its other face
        if (faces_intersect(mesh, mesh.triangles[std::min(f, other)], mesh.triangles[std::max(f, other)]))
          found[block].push_back({std::min(f, other), std::max(f, other)});
      });
    }
  });
  for (const auto& block : found) pairs.insert(pairs.end(), block.begin(), block.end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

std::vector<FacePair> find_self_intersections(const SurfaceMesh& mesh) {
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  return find_pairs(mesh, all, std::vector<char>(mesh.triangles.size(), 1));
}

std::vector<FacePair> find_self_intersections(const SurfaceMesh& mesh, std::span<const std::uint32_t> faces) {
  std::vector<char> named(mesh.triangles.size(), 0);
  std::vector<std::uint32_t> distinct;
  for (const std::uint32_t f : faces) {
    if (named[f] == 0) distinct.push_back(f);
    named[f] = 1;
  }
  return find_pairs(mesh, distinct, named);
}

}  // namespace scan2fea
