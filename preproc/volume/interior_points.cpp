#include "preproc/volume/interior_points.hpp"

#include "preproc/mesh/morton_code.hpp"
#include "preproc/mesh/splitmix64.hpp"
#include "quality/wall_thickness.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {
namespace {

constexpr double mean_edge_per_cell = 0.911;
constexpr double clearance = 0.3;       // of the local edge length
constexpr double beside_surface = 1.6;  // edge length there over the surface's, at most
constexpr double growth = 0.3;          // of edge length per distance from the surface
constexpr double shrinkage = 0.5;       // the same, where the inside is to be finer
constexpr double jitter = 1e-4;         // of a cell
constexpr double wall_in_edges = 0.8;   // thinner is thin

// A place on the finest grid that the octree may reach.
struct GridPlace {
  std::array<std::uint32_t, 3> at;
};

struct LatticePoint {
  std::uint64_t key;
  double cell;
  Vec3 place;
  bool known_inside;  // and clear of the surface
  std::uint32_t nearest;
};

class LatticeTree {
 public:
  LatticeTree(const SurfaceMesh& surface, const InsideTest& inside, const InteriorSize& size)
      : inside_(inside), size_(size) {
    const std::vector<double> of_vertex = surface_sizes(surface);
    largest_surface_size_ = 0;
    for (const Triangle& t : surface.triangles) {
      surface_size_.push_back((of_vertex[t[0]] + of_vertex[t[1]] + of_vertex[t[2]]) / 3);
      largest_surface_size_ = std::max(largest_surface_size_, surface_size_.back());
    }
    // One level of the tree has exactly the cells that the mean edge asks for.
    double cell = edge_length(mean_edge_length(surface), 0) / mean_edge_per_cell;
    const BoundingBox box = bounding_box(surface.vertices);
    const double extent = (box.high - box.low).maxCoeff() + cell;
    while (cell < extent) cell *= 2;
    root_cell_ = cell;
    origin_ = (box.low + box.high) / 2 - Vec3::Constant(cell / 2);
    unit_ = cell / (1 << (morton_bits - 1));
  }

  std::vector<Vec3> points() {
    visit({{0, 0, 0}}, 1U << (morton_bits - 1), 0);
    std::sort(found_.begin(), found_.end(), [](const LatticePoint& a, const LatticePoint& b) {
      return a.key != b.key ? a.key < b.key : a.known_inside > b.known_inside;
    });
    std::vector<Vec3> result;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const LatticePoint& p = found_[i];
      if (i > 0 && found_[i - 1].key == p.key) continue;
      if (!p.known_inside) {
        const InsideTest::Answer answer = inside_(p.place, p.nearest);
        if (!answer.inside || answer.distance < clearance * surface_size_[answer.triangle]) continue;
      }
      result.push_back(p.place + displacement(p));
    }
    return result;
  }

 private:
  double edge_length(double of_surface, double depth) const {
    const double wanted = size_.unit == InteriorSize::Unit::model ? size_.value : size_.value * of_surface;
    return std::clamp(wanted, of_surface - shrinkage * depth, beside_surface * of_surface + growth * depth);
  }

  double wanted_cell(const InsideTest::Answer& answer) const {
    return edge_length(surface_size_[answer.triangle], answer.distance) / mean_edge_per_cell;
  }

  void visit(const GridPlace& low, std::uint32_t width, std::uint32_t hint) {
    const double cell = width * unit_;
    const GridPlace middle{{low.at[0] + width / 2, low.at[1] + width / 2, low.at[2] + width / 2}};
    const InsideTest::Answer answer = inside_(place(middle), hint);
    const double half_diagonal = std::sqrt(0.75) * cell;
    if (!answer.inside && answer.distance > half_diagonal) return;
    // The geometric middle between this cell and its halves decides.
    if (width > 2 && cell > 1.35 * wanted_cell(answer)) {
      for (std::uint32_t child = 0; child < 8; ++child)
        visit({{low.at[0] + (child & 1) * width / 2, low.at[1] + (child >> 1 & 1) * width / 2,
                low.at[2] + (child >> 2) * width / 2}},
              width / 2, answer.triangle);
      return;
    }
    const bool clear = answer.inside && answer.distance > half_diagonal + clearance * largest_surface_size_;
    add(middle, cell, answer.inside && answer.distance >= clearance * surface_size_[answer.triangle], answer.triangle);
    for (std::uint32_t corner = 0; corner < 8; ++corner)
      add({{low.at[0] + (corner & 1) * width, low.at[1] + (corner >> 1 & 1) * width,
            low.at[2] + (corner >> 2) * width}},
          cell, clear, answer.triangle);
  }

  void add(const GridPlace& at, double cell, bool known_inside, std::uint32_t nearest) {
    found_.push_back({morton_code(at.at[0], at.at[1], at.at[2]), cell, place(at), known_inside, nearest});
  }

  Vec3 place(const GridPlace& p) const { return origin_ + unit_ * Vec3(p.at[0], p.at[1], p.at[2]); }

  static Vec3 displacement(const LatticePoint& p) {
    const std::uint64_t random = splitmix64(p.key);
    Vec3 d;
    for (int k = 0; k < 3; ++k) d[k] = static_cast<double>(random >> (21 * k) & 0x1fffff) / 0x100000 - 1;
    return jitter * p.cell * d;
  }

  const InsideTest& inside_;
  const InteriorSize& size_;
  std::vector<double> surface_size_;  // per triangle
  double largest_surface_size_;
  double root_cell_, unit_;
  Vec3 origin_;
  std::vector<LatticePoint> found_;
};

}  // namespace

std::vector<double> surface_sizes(const SurfaceMesh& surface) {
  std::vector<double> size(surface.vertices.size(), 0), weight(surface.vertices.size(), 0);
  for (const Triangle& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = (surface.vertices[t[k]] - surface.vertices[t[(k + 1) % 3]]).norm();
      for (const std::uint32_t v : {t[k], t[(k + 1) % 3]}) {
        size[v] += length;
        weight[v] += 1;
      }
    }
  for (std::size_t v = 0; v < size.size(); ++v)
    if (weight[v] > 0) size[v] /= weight[v];
  for (int round = 0; round < 4; ++round) {
    std::vector<double> sum(size.size(), 0), count(size.size(), 0);
    for (const Triangle& t : surface.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        sum[t[k]] += size[t[(k + 1) % 3]] + size[t[(k + 2) % 3]];
        count[t[k]] += 2;
      }
    for (std::size_t v = 0; v < size.size(); ++v)
      if (count[v] > 0) size[v] = (size[v] + sum[v] / count[v]) / 2;
  }
  return size;
}

std::vector<Vec3> lattice_points(const SurfaceMesh& surface, const InsideTest& inside, const InteriorSize& size) {
  return LatticeTree(surface, inside, size).points();
}

double thin_wall_share(const SurfaceMesh& surface, const InsideTest& inside) {
  const std::vector<double> of_vertex = surface_sizes(surface);
  const std::size_t stride = std::max<std::size_t>(1, surface.triangles.size() / 2000);
  double thin = 0, all = 0;
  for (std::size_t i = 0; i < surface.triangles.size(); i += stride) {
    const Triangle& t = surface.triangles[i];
    const Vec3 normal = area_vector(surface, t);
    const double edge = (of_vertex[t[0]] + of_vertex[t[1]] + of_vertex[t[2]]) / 3;
    const Vec3 centre = centroid(surface, t);
    all += normal.norm();
    if (find_wall(surface, inside.tree(), centre, normal.normalized(), {.deepest = wall_in_edges * edge}))
      thin += normal.norm();
  }
  return all > 0 ? thin / all : 0;
}

}  // namespace scan2fea
