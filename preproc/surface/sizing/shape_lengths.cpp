#include "preproc/surface/sizing/shape_lengths.hpp"

#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/sizing/sizing_field.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/triangle_tree.hpp"
#include "quality/wall_thickness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace scan2fea {
namespace {

// With longer edges the lattice joins the sides of a wall.
constexpr double lengths_of_wall = 2;
// Two edges on a quarter of a circle, three at most.
constexpr double lengths_of_turn = 1.3;
constexpr double turn_deg = 45;
// Two rows of triangles in a strip are equilateral at 0.58. One row, at 1.15, were half as many, but samples on both
// sides of it lie opposite one another, and then its triangles are halves of squares.
constexpr double lengths_of_strip = 0.6;
// Cosine of the angle between creases that make a strip.
constexpr double side_by_side = 0.87;
// Straight lines through the middle of a triangle along which is looked.
constexpr int lines = 4;

struct Shape {
  const SurfaceMesh& mesh;
  const std::vector<Triangle>& neighbours;
  const std::vector<Vec3>& normals;
  const std::vector<FeatureEdge>& creases;

  bool is_crease(std::uint32_t a, std::uint32_t b) const {
    return std::binary_search(creases.begin(), creases.end(), feature_edge(a, b));
  }
};

// What a straight way on the surface comes to first.
struct End {
  double distance = std::numeric_limits<double>::infinity();
  std::optional<Vec3> crease = {};  // its direction; absent where the surface has turned
};

End walk(const Shape& shape, std::uint32_t start, Vec3 place, Vec3 way, double longest) {
  const double least_cosine = std::cos(turn_deg * std::numbers::pi / 180) + 1e-6;
  const Vec3& first_normal = shape.normals[start];
  double gone = 0;
  std::uint32_t f = start, from = no_face;
  while (gone < longest) {
    const Triangle& t = shape.mesh.triangles[f];
    const Vec3& normal = shape.normals[f];
    std::size_t exit = 3;
    double step = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t g = shape.neighbours[f][k];
      if (g != no_face && g == from) continue;
      const Vec3& a = shape.mesh.vertices[t[(k + 1) % 3]];
      const Vec3 outward = (shape.mesh.vertices[t[(k + 2) % 3]] - a).cross(normal);
      const double speed = way.dot(outward);
      if (!(speed > 0)) continue;
      if (const double s = std::max(0.0, (a - place).dot(outward) / speed); s < step) {
        step = s;
        exit = k;
      }
    }
    if (exit == 3) return {};
    gone += step;
    place += step * way;
    const std::uint32_t a = t[(exit + 1) % 3], b = t[(exit + 2) % 3];
    const Vec3 along = (shape.mesh.vertices[b] - shape.mesh.vertices[a]).normalized();
    if (shape.is_crease(a, b)) return {gone, along};
    const std::uint32_t g = shape.neighbours[f][exit];
    if (g == no_face) return {};
    if (shape.normals[g].dot(first_normal) < least_cosine) return {gone, {}};
    way = (way.dot(along) * along + way.dot(along.cross(normal)) * along.cross(shape.normals[g])).normalized();
    from = f;
    f = g;
  }
  return {};
}

// Of turn and strip, looked for as far as they matter.
double length_along(const Shape& shape, std::uint32_t f, const Vec3& middle, double shortest, double longest) {
  const Triangle& t = shape.mesh.triangles[f];
  const Vec3 x = (shape.mesh.vertices[t[1]] - shape.mesh.vertices[t[0]]).normalized(), y = shape.normals[f].cross(x);
  double length = longest;
  for (int i = 0; i < lines; ++i) {
    const double angle = std::numbers::pi * i / lines;
    const Vec3 way = std::cos(angle) * x + std::sin(angle) * y;
    const double farthest = length / std::min(lengths_of_turn, lengths_of_strip);
    const End ahead = walk(shape, f, middle, way, farthest), behind = walk(shape, f, middle, -way, farthest);
    for (const End& end : {ahead, behind})
      if (!end.crease) length = std::min(length, lengths_of_turn * end.distance);
    if (!ahead.crease || !behind.crease || std::abs(ahead.crease->dot(*behind.crease)) < side_by_side) continue;
    // Measured across, which the line is not quite.
    const double across = (ahead.distance + behind.distance) * way.cross(*ahead.crease).norm();
    // Sides that are nearly flush are too near for the shortest edges, which would not part them.
    if (lengths_of_strip * across >= shortest) length = std::min(length, lengths_of_strip * across);
  }
  return length;
}

// Per face whether its patch turns so far that it may be both sides of a wall. Where a crease parts the two sides, a
// lattice cannot join them.
std::vector<bool> may_be_walls(const Shape& shape) {
  constexpr double half_open = 0.5;  // cosine, of 60 degrees from the mean: two such do not face one another
  const CutSurface cut = cut_along(shape.mesh, shape.creases);
  const Components patches = find_components(cut.mesh);
  const auto patch = [&](std::size_t f) { return patches.of_vertex[cut.mesh.triangles[f][0]]; };
  std::vector<Vec3> mean(patches.count, Vec3::Zero());
  for (std::size_t f = 0; f < cut.mesh.triangles.size(); ++f)
    mean[patch(f)] += area_vector(cut.mesh, cut.mesh.triangles[f]);
  for (Vec3& m : mean) m.normalize();
  std::vector<bool> turns(patches.count, false), may_be(cut.mesh.triangles.size());
  for (std::size_t f = 0; f < may_be.size(); ++f)
    if (shape.normals[f].dot(mean[patch(f)]) < half_open) turns[patch(f)] = true;
  for (std::size_t f = 0; f < may_be.size(); ++f) may_be[f] = turns[patch(f)];
  return may_be;
}

// Per face.
class ShapeLengths {
  static constexpr double slack = 2;

 public:
  ShapeLengths(double shortest, double longest) : shortest_(shortest), longest_(longest) {}

  // Asks for the faces that changed since.
  void renew(const SurfaceMesh& mesh, const std::vector<FeatureEdge>& creases, const std::vector<double>& known) {
    const std::vector<Triangle> neighbours = face_neighbours(mesh, VertexStars(mesh));
    const std::vector<Vec3> normals = face_normals(mesh);
    const TriangleTree tree(mesh);
    const Shape shape{mesh, neighbours, normals, creases};
    const std::vector<bool> may_be_wall = may_be_walls(shape);
    faces_.resize(mesh.triangles.size(), Triangle{});
    length_.resize(mesh.triangles.size());
    for_each_block(length_.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t f = first; f < last; ++f) {
        const Triangle& t = mesh.triangles[f];
        if (faces_[f] == t) continue;
        faces_[f] = t;
        // What is known of the triangle that this one is a part of bounds the search.
        length_[f] = std::min(longest_, slack * (known[t[0]] + known[t[1]] + known[t[2]]) / 3);
        if (!(normals[f].squaredNorm() > 0)) continue;
        const Vec3 middle = centroid(mesh, t);
        if (may_be_wall[f])
          if (const auto wall = find_wall(mesh, tree, middle, normals[f], {.deepest = length_[f] / lengths_of_wall}))
            length_[f] = std::min(length_[f], lengths_of_wall * wall->thickness);
        length_[f] =
            std::max(shortest_, length_along(shape, static_cast<std::uint32_t>(f), middle, shortest_, length_[f]));
      }
    });
  }

  std::vector<double> of_vertices(std::size_t count) const {
    std::vector<double> length(count, longest_);
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for (const std::uint32_t v : faces_[f]) length[v] = std::min(length[v], length_[f]);
    return length;
  }

 private:
  double shortest_, longest_;
  std::vector<Triangle> faces_;  // of the mesh that was asked last
  std::vector<double> length_;
};

}  // namespace

std::vector<double> part_by_shape(SurfaceMesh& mesh, std::vector<FeatureEdge>& creases, double edges, double shortest,
                                  double longest, double most_triangles) {
  constexpr int most_rounds = 4;  // a long triangle hides what it lies between until it is parted
  // Halves of slivers are slivers again, three of one: on a wire there would be millions, which say nothing more.
  constexpr double most_faces = 250000, most_of_wanted = 4;
  const double most = std::max(
      {most_faces, most_of_wanted * static_cast<double>(mesh.triangles.size()), most_of_wanted * most_triangles});
  ShapeLengths shape(shortest, longest);
  std::vector<double> length(mesh.vertices.size(), longest);
  for (int round = 0;; ++round) {
    SurfaceMesh parted = mesh;
    std::vector<double> of_parted = length;
    std::vector<FeatureEdge> its_creases = creases;
    halve_long_edges(parted, of_parted, its_creases, edges, edges);
    if (static_cast<double>(parted.triangles.size()) > most) return length;
    const bool same = parted.vertices.size() == mesh.vertices.size();
    mesh = std::move(parted);
    length = std::move(of_parted);
    creases = std::move(its_creases);
    if (round == most_rounds || (round > 0 && same)) return length;
    std::sort(creases.begin(), creases.end());
    shape.renew(mesh, creases, length);
    length = shape.of_vertices(mesh.vertices.size());
    const double triangles = predicted_triangles(mesh, {length});
    if (triangles > most_triangles)
      for (double& l : length) l *= std::sqrt(triangles / most_triangles);
  }
}

bool is_part(const SurfaceMesh& mesh) {
  constexpr double plane_deg = 0.5, crease_deg = 40, least_share = 1. / 3;
  const std::vector<Triangle> neighbours = face_neighbours(mesh, VertexStars(mesh));
  const std::vector<Vec3> normals = face_normals(mesh);
  double plane = 0, all = 0;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t g = neighbours[f][k];
      if (g == no_face || g < f) continue;
      const Triangle& t = mesh.triangles[f];
      const double length = (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[(k + 2) % 3]]).norm();
      const double bend_deg = angle_between(normals[f], normals[g]) * 180 / std::numbers::pi;
      all += length;
      if (bend_deg < plane_deg || bend_deg > crease_deg) plane += length;
    }
  return plane > least_share * all;
}

}  // namespace scan2fea
