#include "quality/self_intersections.hpp"

#include "quality/face_blocks.hpp"
#include "quality/triangle_tree.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>

namespace scan2fea {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Corners = std::array<Point, 3>;

Point point(const Vec3& p) {
  return Point(p.x(), p.y(), p.z());
}

Corners corners_of(const std::vector<Vec3>& points, const Triangle& t) {
  return {point(points[t[0]]), point(points[t[1]]), point(points[t[2]])};
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

// What follows settles nearly all pairs of a scan in plain arithmetic. The difference of two doubles is right to 2^-53
// in each component, so a dot product with one is off by less than 1e-15 of the lengths' product, and one of two cross
// products of them by less than 1e-14. Ten times that is certain; products that may have underflown are not believed.
bool is_certain(double squared_value, double squared_magnitude) {
  return squared_value > 1e-26 * squared_magnitude && squared_magnitude > 1e-250;
}

// Two faces at the edge from a to b, with apexes c and d: on opposite sides of it, or at least not folded back by more
// than a right angle.
bool is_surely_unfolded(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 edge = b - a, ac = c - a, ad = d - a;
  const double cosine = edge.cross(ac).dot(edge.cross(ad));
  const double edge2 = edge.squaredNorm();
  return cosine < 0 && is_certain(cosine * cosine, edge2 * edge2 * ac.squaredNorm() * ad.squaredNorm());
}

// Two faces with the vertex `at` in common, the others being `p` and `q`: a plane through it lies between them.
bool is_surely_apart(const Vec3& at, const std::array<Vec3, 2>& p, const std::array<Vec3, 2>& q) {
  const std::array<Vec3, 2> to_p{p[0] - at, p[1] - at}, to_q{q[0] - at, q[1] - at};
  const Vec3 normal = to_q[0] + to_q[1] - to_p[0] - to_p[1];
  const double normal2 = normal.squaredNorm();
  const auto beyond = [&](const Vec3& x, double side) {
    const double height = side * normal.dot(x);
    return height > 0 && is_certain(height * height, normal2 * x.squaredNorm());
  };
  return beyond(to_p[0], -1) && beyond(to_p[1], -1) && beyond(to_q[0], 1) && beyond(to_q[1], 1);
}

// Two faces with nothing in common: a plane across the line of their centres lies between them.
bool is_surely_apart(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q) {
  const Vec3 normal = q[0] + q[1] + q[2] - p[0] - p[1] - p[2];
  double below = 0, above = std::numeric_limits<double>::infinity(), reach2 = 0;
  for (const Vec3& x : {Vec3(p[1] - p[0]), Vec3(p[2] - p[0])}) {
    below = std::max(below, normal.dot(x));
    reach2 = std::max(reach2, x.squaredNorm());
  }
  for (const Vec3& corner : q) {
    const Vec3 x = corner - p[0];
    above = std::min(above, normal.dot(x));
    reach2 = std::max(reach2, x.squaredNorm());
  }
  const double gap = above - below;
  return gap > 0 && is_certain(gap * gap, normal.squaredNorm() * reach2);
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

bool at_edge_intersect(const std::vector<Vec3>& v, const Triangle& s, const Triangle& t, std::size_t i, std::size_t j) {
  const std::uint32_t from = s[(i + 1) % 3], to = s[(i + 2) % 3];
  if (is_surely_unfolded(v[from], v[to], v[s[i]], v[t[j]])) return false;
  const Point a = point(v[from]), b = point(v[to]), c = point(v[s[i]]), d = point(v[t[j]]);
  return CGAL::orientation(a, b, c, d) == CGAL::COPLANAR && CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
}

bool at_vertex_intersect(const std::vector<Vec3>& v, const Triangle& s, const Triangle& t, std::size_t i,
                         std::size_t j) {
  const std::array<Vec3, 2> others_s{v[s[(i + 1) % 3]], v[s[(i + 2) % 3]]};
  const std::array<Vec3, 2> others_t{v[t[(j + 1) % 3]], v[t[(j + 2) % 3]]};
  if (is_surely_apart(v[s[i]], others_s, others_t)) return false;
  const auto meets = [](const Corners& face, const std::array<Point, 2>& segment) {
    return !is_separated(segment, face) &&
           CGAL::do_intersect(Kernel::Triangle_3(face[0], face[1], face[2]), Kernel::Segment_3(segment[0], segment[1]));
  };
  return meets(corners_of(v, s), {point(others_t[0]), point(others_t[1])}) ||
         meets(corners_of(v, t), {point(others_s[0]), point(others_s[1])});
}

bool apart_intersect(const std::vector<Vec3>& v, const Triangle& s, const Triangle& t) {
  if (is_surely_apart({v[s[0]], v[s[1]], v[s[2]]}, {v[t[0]], v[t[1]], v[t[2]]})) return false;
  const Corners p = corners_of(v, s), q = corners_of(v, t);
  return !is_separated(q, p) && !is_separated(p, q) &&
         CGAL::do_intersect(Kernel::Triangle_3(p[0], p[1], p[2]), Kernel::Triangle_3(q[0], q[1], q[2]));
}

// Pairs of a face of the mesh and one of `faces`. `named` tells of every face whether it is one of these.
std::vector<FacePair> find_pairs(const SurfaceMesh& mesh, std::span<const std::uint32_t> faces,
                                 const std::vector<char>& named) {
  std::vector<FacePair> pairs;
  std::vector<std::uint32_t> solid;
  for (const std::uint32_t f : faces) {
    if (is_collinear(mesh.vertices, mesh.triangles[f]))
      pairs.push_back({f, f});
    else
      solid.push_back(f);
  }
  if (solid.empty()) return pairs;
  const TriangleTree tree(mesh, solid);

  // Fixed blocks, gathered in their order: the same result for any number of threads.
  constexpr std::size_t block_size = 512;  // enough faces that handing one out costs nothing beside it
  std::vector<std::vector<FacePair>> found((mesh.triangles.size() + block_size - 1) / block_size);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t block) {
    const std::size_t end = std::min(mesh.triangles.size(), (block + 1) * block_size);
    for (std::size_t i = block * block_size; i < end; ++i) {
      const auto f = static_cast<std::uint32_t>(i);
      const Triangle& t = mesh.triangles[f];
      if (is_collinear(mesh.vertices, t)) continue;
      tree.for_each_overlap(box_of_face(mesh, f), [&](std::uint32_t other) {
        if (named[f] != 0 && other <= f) return;  // that pair is found from its other face
        if (faces_intersect(mesh.vertices, mesh.triangles[std::min(f, other)], mesh.triangles[std::max(f, other)]))
          found[block].push_back({std::min(f, other), std::max(f, other)});
      });
    }
  });
  for (const auto& block : found) pairs.insert(pairs.end(), block.begin(), block.end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// Pairs of a face of block b and one of block c, which may be b itself.
void find_pairs_of_blocks(const SurfaceMesh& mesh, const FaceBlocks& blocks, std::size_t b, std::size_t c,
                          const std::vector<char>& is_flat, std::vector<FacePair>& pairs) {
  const std::span<const std::uint32_t> faces = blocks.faces(b), others = blocks.faces(c);
  std::array<BoundingBox, FaceBlocks::block_size> boxes;
  for (std::size_t j = 0; j < others.size(); ++j) boxes[j] = box_of_face(mesh, others[j]);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const std::uint32_t f = faces[i];
    const BoundingBox box = b == c ? boxes[i] : box_of_face(mesh, f);
    if (is_flat[f] || !boxes_meet(box, blocks.box(c))) continue;
    for (std::size_t j = b == c ? i + 1 : 0; j < others.size(); ++j) {
      const std::uint32_t g = others[j];
      if (is_flat[g] || !boxes_meet(box, boxes[j])) continue;
      const auto [low, high] = std::minmax(f, g);
      if (faces_intersect(mesh.vertices, mesh.triangles[low], mesh.triangles[high])) pairs.push_back({low, high});
    }
  }
}

}  // namespace

bool is_collinear(const std::vector<Vec3>& points, const Triangle& t) {
  const Vec3 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
  const Vec3 ab = b - a, ac = c - a;
  // For most faces one cross product decides: rounding cannot make more of a zero area than the bound.
  if (ab.cross(ac).squaredNorm() > 1e-24 * ab.squaredNorm() * ac.squaredNorm()) return false;
  const Corners p = corners_of(points, t);
  return CGAL::collinear(p[0], p[1], p[2]);
}

bool faces_intersect(const std::vector<Vec3>& points, const Triangle& s, const Triangle& t) {
  const SharedVertices shared = shared_vertices(s, t);
  switch (shared.count) {
    case 0:
      return apart_intersect(points, s, t);
    case 1:
      return at_vertex_intersect(points, s, t, shared.of_first, shared.of_second);
    case 2:
      return at_edge_intersect(points, s, t, 3 - shared.of_first, 3 - shared.of_second);
    default:
      return true;  // the same face twice
  }
}

std::vector<FacePair> find_self_intersections(const SurfaceMesh& mesh) {
  const FaceBlocks blocks(mesh);
  std::vector<char> is_flat(mesh.triangles.size());
  tbb::parallel_for(std::size_t{0}, is_flat.size(),
                    [&](std::size_t f) { is_flat[f] = is_collinear(mesh.vertices, mesh.triangles[f]); });

  // Fixed runs of blocks, gathered in their order: the same result for any number of threads.
  constexpr std::size_t run_length = 64;  // as many faces as above
  std::vector<std::vector<FacePair>> found((blocks.count() + run_length - 1) / run_length);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t run) {
    const std::size_t end = std::min(blocks.count(), (run + 1) * run_length);
    for (std::size_t b = run * run_length; b < end; ++b)
      blocks.for_each_meeting(b, [&](std::size_t c) { find_pairs_of_blocks(mesh, blocks, b, c, is_flat, found[run]); });
  });
  std::vector<FacePair> pairs;
  for (const auto& run : found) pairs.insert(pairs.end(), run.begin(), run.end());
  for (std::uint32_t f = 0; f < is_flat.size(); ++f)
    if (is_flat[f]) pairs.push_back({f, f});
  std::sort(pairs.begin(), pairs.end());
  return pairs;
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
