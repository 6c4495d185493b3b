// Makes the scan of the examples: an L-shaped bracket, 100 mm long, with a fillet and three bolt holes, sampled as a
// scanner samples a part. Its points lie along lines that are neither even nor parallel to the part, edges are rounded,
// and noise moves every point along the surface's normal.
//
//   make_scan OUT [SPACING_MM [NOISE_PERCENT_OF_DIAGONAL [SEED]]]        default: 1 0.03 1
//
// The part is an implicit function; the surface comes from it by surface nets (Gibson, "Constrained elastic surface
// nets", MICCAI 1998): one vertex in each cell of a grid that the surface passes through, one quadrilateral about each
// grid edge that it crosses. That surface is closed by construction. The grid stands for the scanner's lines.
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/write_surface.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

namespace {

using scan2fea::SurfaceMesh;
using scan2fea::Vec3;

// Millimetres. The base lies on z = 0, the upright stands on its end at x = 0.
constexpr double length = 100, width = 40, height = 65, thickness = 10;
constexpr double fillet_radius = 10, edge_radius = 1.5;
constexpr double base_hole_radius = 5.5, base_hole_x[2] = {40, 82}, upright_hole_radius = 9, upright_hole_z = 43;
const double diagonal = Vec3(length, width, height).norm();

// Signed distance, negative inside, nearly exact within an edge radius of the surface. The bracket is where all
// conditions are negative; where two meet, the sum of squares rounds the edge.
double bracket(const Vec3& p) {
  const double x = p[0], y = p[1], z = p[2];
  // Outside of both plates, and rounded where they meet.
  const double over_base = z - thickness, before_upright = x - thickness;
  const double inner_corner =
      std::max(fillet_radius, std::min(over_base, before_upright)) -
      std::hypot(std::max(fillet_radius - over_base, 0.0), std::max(fillet_radius - before_upright, 0.0));
  const std::array<double, 10> conditions{
      -x,
      x - length,
      -y,
      y - width,
      -z,
      z - height,
      inner_corner,
      base_hole_radius - std::hypot(x - base_hole_x[0], y - width / 2),
      base_hole_radius - std::hypot(x - base_hole_x[1], y - width / 2),
      upright_hole_radius - std::hypot(y - width / 2, z - upright_hole_z),
  };
  double squares = 0;
  for (const double c : conditions) squares += std::pow(std::max(c + edge_radius, 0.0), 2);
  return std::min(*std::ranges::max_element(conditions), -edge_radius) + std::sqrt(squares);
}

Vec3 gradient(const Vec3& p) {
  constexpr double step = 1e-4;
  Vec3 g;
  for (int k = 0; k < 3; ++k)
    g[k] = (bracket(p + step * Vec3::Unit(k)) - bracket(p - step * Vec3::Unit(k))) / (2 * step);
  return g;
}

// The planes of the grid along one axis: their distance swells and shrinks along the way, and jitters.
std::vector<double> scan_planes(double low, double high, double spacing, std::mt19937& generator) {
  constexpr double swell = 0.35, jitter = 0.12, wave_length = 60;
  std::uniform_real_distribution<double> any(-jitter, jitter);
  std::vector<double> planes{low - 3 * spacing};
  while (planes.back() < high + 2 * spacing)
    planes.push_back(planes.back() +
                     spacing *
                         (1 + swell * std::sin(2 * std::numbers::pi * planes.back() / wave_length) + any(generator)));
  return planes;
}

class SurfaceNets {
 public:
  // `to_part` turns the scanner's axes into the part's.
  SurfaceNets(std::array<std::vector<double>, 3> planes, const Eigen::Quaterniond& to_part)
      : planes_(std::move(planes)), to_part_(to_part) {
    for (std::size_t k = 0; k < 3; ++k) count_[k] = planes_[k].size();
    distance_.resize(count_[0] * count_[1] * count_[2]);
    vertex_.resize(distance_.size());
    each_node([&](const Node& n) { distance_[index(n)] = bracket(point(n)); });
  }

  SurfaceMesh run() {
    resolve_ambiguous_faces();
    each_node([&](const Node& n) { add_vertex(n); });
    each_node([&](const Node& n) {
      for (std::size_t axis = 0; axis < 3; ++axis) add_quadrilateral(n, axis);
    });
    return std::move(mesh_);
  }

 private:
  using Node = std::array<std::size_t, 3>;

  template <class Visit>
  void each_node(Visit visit) const {
    for (std::size_t i = 0; i < count_[0]; ++i)
      for (std::size_t j = 0; j < count_[1]; ++j)
        for (std::size_t k = 0; k < count_[2]; ++k) visit(Node{i, j, k});
  }

  std::size_t index(const Node& n) const { return (n[0] * count_[1] + n[1]) * count_[2] + n[2]; }
  Vec3 point(const Node& n) const { return to_part_ * Vec3(planes_[0][n[0]], planes_[1][n[1]], planes_[2][n[2]]); }
  bool inside(const Node& n) const { return distance_[index(n)] < 0; }

  static Node next(Node n, std::size_t axis) {
    ++n[axis];
    return n;
  }

  // Four quadrilaterals would share the edge through a grid face whose corners alternate between inside and outside,
  // which happens where the surface grazes it; its corner nearest to the surface changes sides.
  void resolve_ambiguous_faces() {
    for (bool changed = true; changed;) {
      changed = false;
      each_node([&](const Node& n) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
          if (n[u] + 1 == count_[u] || n[v] + 1 == count_[v]) continue;
          const std::array<Node, 4> corners{n, next(n, u), next(next(n, u), v), next(n, v)};
          if (inside(corners[0]) != inside(corners[2]) || inside(corners[1]) != inside(corners[3]) ||
              inside(corners[0]) == inside(corners[1]))
            continue;
          const Node nearest = *std::ranges::min_element(
              corners, {}, [&](const Node& corner) { return std::abs(distance_[index(corner)]); });
          distance_[index(nearest)] *= -1;
          changed = true;
        }
      });
    }
  }

  // Of the cell between n and the nodes behind it: the mean of the crossings of its twelve edges.
  void add_vertex(const Node& n) {
    for (std::size_t k = 0; k < 3; ++k)
      if (n[k] + 1 == count_[k]) return;
    Vec3 sum = Vec3::Zero();
    int crossings = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t side = 0; side < 4; ++side) {
        Node a = n;
        a[(axis + 1) % 3] += side & 1;
        a[(axis + 2) % 3] += side >> 1;
        const Node b = next(a, axis);
        if (inside(a) == inside(b)) continue;
        const double t = distance_[index(a)] / (distance_[index(a)] - distance_[index(b)]);
        sum += (1 - t) * point(a) + t * point(b);
        ++crossings;
      }
    if (crossings == 0) return;
    vertex_[index(n)] = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.emplace_back(sum / crossings);
  }

  // Around the grid edge from n along `axis`, through the vertices of the four cells about it.
  void add_quadrilateral(const Node& n, std::size_t axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (n[axis] + 1 == count_[axis] || n[u] == 0 || n[v] == 0) return;
    const bool from_inside = inside(n);
    if (from_inside == inside(next(n, axis))) return;
    Node cell = n;
    std::array<std::uint32_t, 4> ring;
    ring[0] = vertex_[index(cell)];
    --cell[u];
    ring[1] = vertex_[index(cell)];
    --cell[v];
    ring[2] = vertex_[index(cell)];
    ++cell[u];
    ring[3] = vertex_[index(cell)];
    if (!from_inside) std::swap(ring[1], ring[3]);
    mesh_.triangles.push_back({ring[0], ring[1], ring[2]});
    mesh_.triangles.push_back({ring[0], ring[2], ring[3]});
  }

  std::array<std::vector<double>, 3> planes_;
  Eigen::Quaterniond to_part_;
  Node count_;
  std::vector<double> distance_;       // of each node
  std::vector<std::uint32_t> vertex_;  // of the cell behind each node, where it has one
  SurfaceMesh mesh_;
};

SurfaceMesh scan(double spacing, double noise_of_diagonal, unsigned seed) {
  std::mt19937 generator(seed);
  const Eigen::Quaterniond to_part = Eigen::AngleAxisd(0.13, Vec3::UnitZ()) * Eigen::AngleAxisd(0.09, Vec3::UnitY()) *
                                     Eigen::AngleAxisd(-0.07, Vec3::UnitX());
  const Eigen::AlignedBox3d part(Vec3::Zero(), Vec3(length, width, height));
  Eigen::AlignedBox3d seen;
  for (int c = 0; c < 8; ++c)
    seen.extend(to_part.conjugate() * part.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c)));

  // Points follow one another closely along a line, lines lie further apart.
  const Vec3 spacings = spacing * Vec3(0.8, 1.3, 1.0);
  std::array<std::vector<double>, 3> planes;
  for (int k = 0; k < 3; ++k)
    planes[static_cast<std::size_t>(k)] = scan_planes(seen.min()[k], seen.max()[k], spacings[k], generator);
  SurfaceMesh mesh = SurfaceNets(std::move(planes), to_part).run();

  std::normal_distribution<double> noise(0, noise_of_diagonal * diagonal);
  for (Vec3& p : mesh.vertices) p += noise(generator) * gradient(p).normalized();
  return mesh;
}

std::optional<double> positive_number(const char* text) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  return *end == '\0' && value >= 0 && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace

int main(int argc, char** argv) {
  std::array<double, 3> arguments{1, 0.03, 1};
  bool understood = argc >= 2 && argc <= 5;
  for (int i = 2; i < argc && understood; ++i) {
    const std::optional<double> value = positive_number(argv[i]);
    understood = value.has_value();
    if (value) arguments[static_cast<std::size_t>(i - 2)] = *value;
  }
  constexpr double finest = 0.15, coarsest = edge_radius;  // mm: memory, and cells that the surface passes once
  if (!understood || arguments[0] < finest || arguments[0] > coarsest) {
    std::fprintf(stderr, "usage: make_scan OUT [SPACING_MM [NOISE_PERCENT_OF_DIAGONAL [SEED]]]; spacing %g to %g\n",
                 finest, coarsest);
    return 2;
  }
  try {
    const SurfaceMesh mesh = scan(arguments[0], arguments[1] / 100, static_cast<unsigned>(arguments[2]));
    scan2fea::write_surface(mesh, argv[1]);
    std::printf("%s: %zu vertices, %zu triangles\n", argv[1], mesh.vertices.size(), mesh.triangles.size());
  } catch (const scan2fea::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
  }
}
