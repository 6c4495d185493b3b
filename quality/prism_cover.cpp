#include "quality/prism_cover.hpp"

#include "preproc/mesh/face_neighbours.hpp"
#include "preproc/mesh/vertex_welder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scan2fea {
namespace {

// Of the extent, the largest number that a projected point is computed from: its error is below 1e-15 of that.
constexpr double rim_of_extent = 1e-14;
// A corner of less than this many radians has a point so far from the rest that it is left to others.
constexpr double smallest_angle = 1e-6;
// Where the degree is asked for, as weights of the corners: off the centre and all symmetries, since scans and surfaces
// are often laid out regularly. The next one is tried where an edge passes too near.
constexpr std::array<std::array<double, 3>, 3> places_of_degree{
    {{0.4127, 0.3301, 0.2572}, {0.2243, 0.4391, 0.3366}, {0.3519, 0.1927, 0.4554}}};

constexpr std::uint32_t no_leaf = ~0U;

double cross_of(double ax, double ay, double bx, double by) {
  return ax * by - ay * bx;
}

// As face_neighbours, but where it sees a border because faces do not share the vertices there, as along cuts, those
// with the same points are neighbours.
std::vector<Triangle> neighbours_by_points(const SurfaceMesh& mesh) {
  std::vector<Triangle> neighbours = face_neighbours(mesh, VertexStars(mesh));
  const auto has_border = [](const Triangle& n) { return std::find(n.begin(), n.end(), no_face) != n.end(); };
  if (std::none_of(neighbours.begin(), neighbours.end(), has_border)) return neighbours;
  VertexWelder welder(mesh.vertices.size());
  std::vector<std::uint32_t> place(mesh.vertices.size());
  for (std::size_t v = 0; v < place.size(); ++v) place[v] = welder.add(mesh.vertices[v]);
  SurfaceMesh welded{welder.take_vertices(), mesh.triangles};
  if (welded.vertices.size() == mesh.vertices.size()) return neighbours;
  for (Triangle& t : welded.triangles)
    for (std::uint32_t& v : t) v = place[v];
  const std::vector<Triangle> met = face_neighbours(welded, VertexStars(welded));
  for (std::size_t f = 0; f < met.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k)
      if (neighbours[f][k] == no_face) neighbours[f][k] = met[f][k];
  return neighbours;
}

}  // namespace

LeafEdges::LeafEdges(const SurfaceMesh& mesh, const TriangleTree& tree) : across_(mesh.triangles.size()) {
  const std::vector<Triangle> neighbours = neighbours_by_points(mesh);
  const auto same = [&](std::uint32_t v, std::uint32_t w) { return v == w || mesh.vertices[v] == mesh.vertices[w]; };
  for (std::uint32_t leaf = 0; leaf < across_.size(); ++leaf) {
    const std::uint32_t f = tree.leaf_order()[leaf];
    const Triangle& t = mesh.triangles[f];
    for (std::size_t k = 0; k < 3; ++k) {
      across_[leaf][k] = none;
      const std::uint32_t g = neighbours[f][k];
      if (g == no_face) continue;
      const Triangle& u = mesh.triangles[g];
      for (std::uint32_t j = 0; j < 3; ++j)
        if (same(u[(j + 1) % 3], t[(k + 2) % 3]) && same(u[(j + 2) % 3], t[(k + 1) % 3]))
          across_[leaf][k] = tree.leaf_of(g) << 2 | j;
    }
  }
}

void MetLeaves::clear() {
  for (const std::uint32_t slot : taken_) slots_[slot] = no_leaf;
  taken_.clear();
}

bool MetLeaves::insert(std::uint32_t leaf) {
  constexpr std::size_t fewest_slots = 128;
  if (2 * (taken_.size() + 1) > slots_.size()) {
    const std::vector<std::uint32_t> before = std::exchange(slots_, {});
    slots_.assign(std::max(fewest_slots, 2 * before.size()), no_leaf);
    for (const std::uint32_t slot : std::exchange(taken_, {})) place(before[slot]);
  }
  return place(leaf);
}

bool MetLeaves::place(std::uint32_t leaf) {
  constexpr std::uint32_t golden = 2654435769U;  // spreads neighbours
  std::size_t slot = ((leaf * golden) >> 7) & (slots_.size() - 1);
  for (; slots_[slot] != no_leaf; slot = (slot + 1) & (slots_.size() - 1))
    if (slots_[slot] == leaf) return false;
  slots_[slot] = leaf;
  taken_.push_back(static_cast<std::uint32_t>(slot));
  return true;
}

bool PrismCover::covers(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t seed, double most_height) {
  if (!lay(a, b, c) || !walk(seed, most_height)) return false;
  const int times = degree();
  if (times == 0) return false;
  measure(times);
  return true;
}

// Sets up the triangle's frame; false where it has none.
bool PrismCover::lay(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 area = ab.cross(ac);
  const double length = ab.norm(), twice_area = area.norm();
  const double size = std::max({length, ac.norm(), (c - b).norm()});
  rim_ = rim_of_extent * (size + 0.5 * box_.diagonal() + (0.5 * (box_.low + box_.high) - a).norm());
  if (!(twice_area > smallest_angle * size * size) || !(twice_area > 100 * rim_ * size)) return false;
  // A corner of angle t is rim / sin(t / 2) from the rest, and sin(t) is at least twice the area over size squared.
  slack_ = 2 * rim_ * size * size / twice_area;
  origin_ = a;
  along_ = ab / length;
  normal_ = area / twice_area;
  across_ = normal_.cross(along_);
  triangle_ = {{{0, 0}, {length, 0}, {along_.dot(ac), across_.dot(ac)}}};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto &from = triangle_[k], &to = triangle_[(k + 1) % 3];
    const double dx = to[0] - from[0], dy = to[1] - from[1], l = std::sqrt(dx * dx + dy * dy);
    edges_[k] = {-dy / l, dx / l, (dy * from[0] - dx * from[1]) / l};
  }
  return true;
}

PrismCover::Point PrismCover::project(const Vec3& point) const {
  const Vec3 d = point - origin_;
  Point p{along_.dot(d), across_.dot(d), normal_.dot(d), 0};
  for (unsigned k = 0; k < 3; ++k)
    if (distance(edges_[k], p) < rim_) p.outside |= 1U << k;
  return p;
}

// From the seed across all edges that may meet the triangle; false where one leads nowhere, or too high.
bool PrismCover::walk(std::uint32_t seed, double most_height) {
  met_.clear();
  parts_.clear();
  met_.insert(seed);
  const auto& [a, b, c] = tree_.corners_of_leaf(seed);
  parts_.push_back({seed, {project(a), project(b), project(c)}, -1});
  std::size_t next = 0;
  while (next < parts_.size()) {
    const Part part = parts_[next++];  // the list grows below
    const auto [low, high] = std::minmax({part.corners[0].height, part.corners[1].height, part.corners[2].height});
    if (low > most_height || high < -most_height) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (may_meet(part.corners[(k + 1) % 3], part.corners[(k + 2) % 3]) && !cross(part, k)) return false;
  }
  return true;
}

// Adds the part across the edge opposite to a corner; false where there is none.
bool PrismCover::cross(const Part& from, std::size_t corner) {
  const std::uint32_t edge = leaf_edges_.across(from.leaf, corner);
  if (edge == LeafEdges::none) return false;
  const std::uint32_t leaf = LeafEdges::leaf(edge), apex = LeafEdges::corner(edge);
  if (!met_.insert(leaf)) return true;
  Part& part = parts_.emplace_back();
  part.leaf = leaf;
  part.height = -1;
  part.corners[apex] = project(tree_.corners_of_leaf(leaf)[apex]);
  part.corners[(apex + 1) % 3] = from.corners[(corner + 2) % 3];
  part.corners[(apex + 2) % 3] = from.corners[(corner + 1) % 3];
  return true;
}

// Whether the segment may meet the triangle without its rim: clipped by half-planes somewhat larger than that, such
// that rounding does not tell, there is something left.
bool PrismCover::may_meet(const Point& p, const Point& q) const {
  if ((p.outside & q.outside) != 0) return false;
  if (p.outside == 0 || q.outside == 0) return true;
  double first = 0, last = 1;
  for (const Line& edge : edges_) {
    const double at_p = distance(edge, p) - 0.5 * rim_, at_q = distance(edge, q) - 0.5 * rim_;
    if (at_p < 0 && at_q < 0) return false;
    if (at_p < 0) first = std::max(first, at_p / (at_p - at_q));
    if (at_q < 0) last = std::min(last, at_p / (at_p - at_q));
  }
  return first <= last;
}

// 1 or -1 where the part lies over the place, by its orientation, else 0; `is_clear` becomes false near its edges.
int PrismCover::covers_at(const Part& part, double x, double y, bool& is_clear) const {
  int left = 0, right = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point &p = part.corners[k], &q = part.corners[(k + 1) % 3];
    const double qx = q.x - p.x, qy = q.y - p.y, dx = x - p.x, dy = y - p.y;
    const double side = cross_of(qx, qy, dx, dy);
    const double error = rim_ * (std::abs(qx) + std::abs(qy) + std::abs(dx) + std::abs(dy));
    left += side > error ? 1 : 0;
    right += side < -error ? 1 : 0;
  }
  if (left == 3) return 1;
  if (right == 3) return -1;
  if (left == 0 || right == 0) is_clear = false;
  return 0;
}

// How often the parts lie over the triangle, the same all over it; 0 where that is so, or no place is clear.
int PrismCover::degree() const {
  for (const auto& weight : places_of_degree) {
    double x = 0, y = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      x += weight[k] * triangle_[k][0];
      y += weight[k] * triangle_[k][1];
    }
    bool is_clear = true;
    int times = 0;
    for (std::size_t i = 0; i < parts_.size() && is_clear; ++i) times += covers_at(parts_[i], x, y, is_clear);
    if (is_clear) return times;
  }
  return 0;
}

// The part's polygon over the triangle (Sutherland and Hodgman, 1974).
PrismCover::Clipped PrismCover::clipped(const Part& part) const {
  const auto& [a, b, c] = part.corners;
  const unsigned crossed = a.outside | b.outside | c.outside;
  Clipped polygon{{a, b, c}, 3};
  for (std::size_t k = 0; k < 3; ++k)
    if ((crossed >> k & 1U) != 0) clip(polygon, edges_[k]);
  return polygon;
}

void PrismCover::clip(Clipped& polygon, const Line& edge) {
  const std::array<Point, most_corners> before = polygon.corners;
  const std::size_t size = std::exchange(polygon.size, 0);
  if (size == 0) return;
  const Point* from = &before[size - 1];
  double at_from = distance(edge, *from);
  for (std::size_t i = 0; i < size; ++i) {
    const Point& to = before[i];
    const double at_to = distance(edge, to);
    if ((at_from >= 0) != (at_to >= 0)) {
      const double t = at_from / (at_from - at_to);
      polygon.corners[polygon.size++] = {from->x + t * (to.x - from->x), from->y + t * (to.y - from->y),
                                         from->height + t * (to.height - from->height), 0};
    }
    if (at_to >= 0) polygon.corners[polygon.size++] = to;
    from = &to;
    at_from = at_to;
  }
}

// The heights of the parts that cover the triangle: those that are turned as the sum of all is.
void PrismCover::measure(int degree) {
  double highest = 0, x = 0, y = 0;
  for (Part& part : parts_) {
    const auto& [a, b, c] = part.corners;
    if (degree * cross_of(b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y) < 0) continue;
    part.height = std::max({std::abs(a.height), std::abs(b.height), std::abs(c.height)}) + slack_;
    if (part.height <= highest + slack_) continue;
    const Clipped over = clipped(part);
    part.height = -1;
    for (std::size_t i = 0; i < over.size; ++i) {
      const Point& p = over.corners[i];
      part.height = std::max(part.height, std::abs(p.height) + slack_);
      if (std::abs(p.height) <= highest) continue;
      highest = std::abs(p.height);
      x = p.x;
      y = p.y;
    }
  }
  largest_height_ = highest + slack_;
  foot_of_highest_ = in_space(x, y);
}

PrismCover::Polygon PrismCover::foot_of(const Part& part) const {
  const Clipped over = clipped(part);
  Polygon foot;
  foot.size = over.size;
  for (std::size_t i = 0; i < over.size; ++i) {
    foot.corners[i] = in_space(over.corners[i].x, over.corners[i].y);
    foot.height = std::max(foot.height, std::abs(over.corners[i].height) + slack_);
  }
  return foot;
}

}  // namespace scan2fea
