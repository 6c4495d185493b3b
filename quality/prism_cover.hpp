// Which parts of a surface lie over a triangle, seen along the triangle's normal, and how far above or below it.
//
// Let T be the interior of the triangle, p the projection along its normal into its plane, and W a set of the surface's
// triangles such that across every edge of theirs whose projection meets T there is exactly one other triangle of the
// surface, of the opposite direction at the edge, and that one is in W too. W is found by walking across such edges.
//   The projections p(w), w in W, with their orientations are a chain of triangles in the plane. In its boundary the
// edges shared within W cancel, so that only edges remain whose projections do not meet T. The degree of the chain (at
// a point off all projected edges: the number of counter-clockwise p(w) over it less that of clockwise ones) changes
// only across the boundary, hence is one number d for all of T, which is connected; one point tells it. If d > 0, over
// every point of T that is off the edges there is at least one counter-clockwise p(w); those points are dense in T and
// the p(w) are closed, so that the counter-clockwise p(w) cover T and its border (if d < 0 the clockwise ones do, and
// if d = 0 nothing is known). A point of the triangle that lies in p(w) is no farther from the surface than w is high
// over it; over the part that w covers, a convex polygon, the height is linear. So no point of the triangle is farther
// from the surface than the largest height at the corners of these polygons. Folds, other sheets and holes beside the
// triangle do not matter; a border, or an edge of more than two triangles or of two of like direction, over the
// triangle leaves it without an answer.
//   Rounding: T is the interior less a rim some ten times as wide as the error of a projected point. What is proved for
// T holds for the whole triangle with the distance of its corners from T added to all heights (about 1e-13 of the
// surface's extent; more for needles).
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/triangle_tree.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

// Who lies across the edges of a tree's leaves. An edge is a leaf and the corner opposite to it, in one number.
class LeafEdges {
 public:
  static constexpr std::uint32_t none = ~0U;
  static std::uint32_t leaf(std::uint32_t edge) { return edge >> 2; }
  static std::uint32_t corner(std::uint32_t edge) { return edge & 3; }

  // Of a surface and the tree of all its triangles. Triangles that do not share the vertices of an edge, but their
  // points, lie across from each other too. Linear in the mesh.
  LeafEdges(const SurfaceMesh& mesh, const TriangleTree& tree);

  // The same edge in the other direction, of another triangle as a rule; none at a border, and where an edge is not
  // that of exactly two triangles of opposite direction.
  std::uint32_t across(std::uint32_t leaf, std::size_t corner) const { return across_[leaf][corner]; }

 private:
  std::vector<std::array<std::uint32_t, 3>> across_;
};

// The leaves met on a walk; a table that grows with them, not with the surface.
class MetLeaves {
 public:
  void clear();
  bool insert(std::uint32_t leaf);  // false where it was there already

 private:
  bool place(std::uint32_t leaf);

  std::vector<std::uint32_t> slots_;  // a power of two of them, at most half of them taken
  std::vector<std::uint32_t> taken_;
};

// Holds its working memory from triangle to triangle: one for each thread.
class PrismCover {
 public:
  struct Point {
    double x, y;       // in the triangle's plane
    double height;     // over it
    unsigned outside;  // bit k: beyond the triangle's k-th edge, or on its rim
  };
  struct Part {
    std::uint32_t leaf;  // of the surface's tree
    std::array<Point, 3> corners;
    // The largest, of either sign, over the triangle; of the whole leaf where even that does not raise the largest
    // of all parts. Negative where the part is none of those that cover.
    double height;
  };
  // A triangle cut by three lines has at most six corners; where it is a sliver, rounding may give it up to nine.
  static constexpr std::size_t most_corners = 9;
  struct Polygon {
    std::array<Vec3, most_corners> corners;
    std::size_t size = 0;
    double height = 0;  // the largest over its corners
  };

  // All must outlive this; they are of one surface.
  PrismCover(const TriangleTree& tree, const LeafEdges& edges, const BoundingBox& box)
      : tree_(tree), leaf_edges_(edges), box_(box) {}

  // Whether the triangle abc is covered by parts that `seed`, a leaf of the tree, leads to; false as well where that
  // cannot be told, where abc has no area, or where a part is higher than `most_height` all over: there the walk is on
  // its way to places that tell nothing. Linear in the parts, about 50 ns each.
  bool covers(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t seed, double most_height);

  // After `covers` said yes:
  const std::vector<Part>& parts() const { return parts_; }
  double largest_height() const { return largest_height_; }
  double slack() const { return slack_; }                    // for rounding; heights hold it already
  Vec3 foot_of_highest() const { return foot_of_highest_; }  // the point of the triangle below (or above) it
  Polygon foot_of(const Part& part) const;                   // what the part covers of the triangle

 private:
  struct Line {  // signed distance of (x, y), inwards: nx x + ny y + offset
    double nx, ny, offset;
  };
  struct Clipped {
    std::array<Point, most_corners> corners;
    std::size_t size;
  };

  bool lay(const Vec3& a, const Vec3& b, const Vec3& c);
  Point project(const Vec3& point) const;
  static double distance(const Line& line, const Point& p) { return line.nx * p.x + line.ny * p.y + line.offset; }
  Vec3 in_space(double x, double y) const { return origin_ + x * along_ + y * across_; }
  bool walk(std::uint32_t seed, double most_height);
  bool cross(const Part& from, std::size_t corner);
  bool may_meet(const Point& p, const Point& q) const;
  int degree() const;
  int covers_at(const Part& part, double x, double y, bool& is_clear) const;
  Clipped clipped(const Part& part) const;
  static void clip(Clipped& polygon, const Line& edge);
  void measure(int degree);

  const TriangleTree& tree_;
  const LeafEdges& leaf_edges_;
  const BoundingBox& box_;
  Vec3 origin_, along_, across_, normal_;  // the triangle's frame: its first corner, and unit vectors
  std::array<std::array<double, 2>, 3> triangle_;
  std::array<Line, 3> edges_;
  double rim_;  // its width
  double slack_;
  MetLeaves met_;
  std::vector<Part> parts_;
  double largest_height_;
  Vec3 foot_of_highest_;
};

}  // namespace scan2fea
