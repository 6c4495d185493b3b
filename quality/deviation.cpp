#include "quality/deviation.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/splitmix64.hpp"
#include "quality/curved_surface.hpp"
#include "quality/triangle_tree.hpp"
#include "quality/validity.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace scan2fea {
namespace {

constexpr std::size_t block_size = 2048;  // of samples; fixed, so that sums round the same for any number of threads

// Numbers in [0, 1) that depend on nothing but the seed and the index, so that samples can be drawn in parallel.
class IndexedRandom {
 public:
  explicit IndexedRandom(std::uint64_t seed) : key_(splitmix64(seed)) {}
  double operator()(std::uint64_t index) const {
    return static_cast<double>(splitmix64(key_ + index * splitmix64_step) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t key_;
};

// What distances are measured from and to: a mesh, or the flat pieces of a curved one.
struct Surface {
  const SurfaceMesh& mesh;
  TriangleTree tree;
  std::vector<double> area_up_to;      // inclusive, along the tree's leaf order
  std::vector<Vec3> vertices;          // in the order in which the leaves meet them
  const FlatPieces* pieces = nullptr;  // of which the samples are on the curves
  const TetMesh* solid = nullptr;      // whose boundary these are

  explicit Surface(const SurfaceMesh& m) : mesh(m), tree(m) {
    add_areas();
    std::vector<char> met(m.vertices.size(), 0);
    for (const std::uint32_t t : tree.leaf_order())
      for (const std::uint32_t v : m.triangles[t]) meet(m.vertices, v, met);
  }

  Surface(const FlatPieces& p, const TetMesh& of) : mesh(p.mesh), tree(p.mesh), pieces(&p), solid(&of) {
    add_areas();
    std::vector<char> met(p.nodes.size(), 0);
    for (const std::uint32_t t : tree.leaf_order())
      for (const std::uint32_t v : p.curved[p.of_piece[t]].nodes) meet(p.nodes, v, met);
  }

  double area() const { return area_up_to.back(); }

  // A random point of the i-th of n parts of equal area.
  Vec3 sample(std::size_t i, std::size_t n, const IndexedRandom& random) const {
    const double position = (static_cast<double>(i) + random(3 * i)) / static_cast<double>(n) * area();
    const auto leaf =
        std::min<std::ptrdiff_t>(std::upper_bound(area_up_to.begin(), area_up_to.end(), position) - area_up_to.begin(),
                                 static_cast<std::ptrdiff_t>(area_up_to.size()) - 1);
    const std::uint32_t triangle = tree.leaf_order()[static_cast<std::size_t>(leaf)];
    const auto& [a, b, c] = mesh.triangles[triangle];
    // Uniform over the triangle (Osada et al., "Shape distributions", 2002, eq. 1).
    const double r = std::sqrt(random(3 * i + 1)), s = random(3 * i + 2);
    if (pieces != nullptr) return pieces->on_curve(triangle, 1 - r, r * (1 - s));
    return (1 - r) * mesh.vertices[a] + r * (1 - s) * mesh.vertices[b] + r * s * mesh.vertices[c];
  }

 private:
  void add_areas() {
    area_up_to.reserve(mesh.triangles.size());
    double sum = 0;
    for (const std::uint32_t t : tree.leaf_order()) {
      sum += 0.5 * area_vector(mesh, mesh.triangles[t]).norm();
      area_up_to.push_back(sum);
    }
  }
  void meet(const std::vector<Vec3>& points, std::uint32_t v, std::vector<char>& met) {
    if (met[v] == 0) vertices.push_back(points[v]);
    met[v] = 1;
  }
};

struct Distances {
  double sum_squared = 0;
  double largest_squared = -1;
  Vec3 farthest = Vec3::Zero(), nearest_to_it = Vec3::Zero();

  void add(const Distances& later) {
    sum_squared += later.sum_squared;
    if (later.largest_squared <= largest_squared) return;
    largest_squared = later.largest_squared;
    farthest = later.farthest;
    nearest_to_it = later.nearest_to_it;
  }
};

// From the vertices and samples of one surface to the other. Samples follow the leaves, so each is near the last one,
// whose nearest triangle is a good first guess.
Distances measure_side(const Surface& from, const Surface& to, std::size_t samples, const IndexedRandom& random) {
  const std::size_t count = from.vertices.size() + samples;
  std::vector<Distances> blocks((count + block_size - 1) / block_size);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
    const std::size_t begin = block * block_size, end = std::min(count, begin + block_size);
    std::uint32_t hint = to.tree.leaf_order()[0];
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 p =
          i < from.vertices.size() ? from.vertices[i] : from.sample(i - from.vertices.size(), samples, random);
      const ClosestPoint nearest = to.tree.closest(p, hint);
      hint = nearest.triangle;
      blocks[block].add({nearest.squared_distance, nearest.squared_distance, p, nearest.point});
    }
  });
  Distances all;
  for (const Distances& block : blocks) all.add(block);
  all.sum_squared /= static_cast<double>(count);
  return all;
}

std::optional<double> volume_of(const Surface& surface) {
  const SurfaceMesh boundary = surface.solid != nullptr ? boundary_surface(*surface.solid) : SurfaceMesh{};
  if (!check_validity(surface.solid != nullptr ? boundary : surface.mesh).encloses_volume()) return std::nullopt;
  const double volume =
      std::abs(surface.solid != nullptr ? total_volume(*surface.solid) : enclosed_volume(surface.mesh));
  const bool is_flat = volume <= least_volume_of_area * std::pow(surface.area(), 1.5);
  return is_flat ? std::nullopt : std::optional(volume);
}

void require_area(const Surface& surface, const std::string& which) {
  if (!(surface.area() > 0) || !std::isfinite(surface.area()))
    throw InvalidInput({.what = "a distance needs two surfaces",
                        .where = which,
                        .value = "area " + std::to_string(surface.area()),
                        .limit = "above 0 and finite",
                        .advice = {}});
}

Deviation between(const Surface& own, const Surface& other, const DeviationOptions& options) {
  require_area(own, "mesh");
  require_area(other, "reference");

  Deviation deviation;
  const auto volume = volume_of(own);
  const auto reference_volume = options.reference_volume ? options.reference_volume : volume_of(other);
  if (volume && reference_volume)
    deviation.volume_difference_pct = 100 * (*volume - *reference_volume) / *reference_volume;
  deviation.area_difference_pct = 100 * (own.area() - other.area()) / other.area();

  const IndexedRandom random(options.seed);
  const Distances to_reference = measure_side(own, other, options.samples, random);
  const Distances to_mesh = measure_side(other, own, options.samples, IndexedRandom(options.seed + 1));
  deviation.farthest_is_on_reference = to_mesh.largest_squared > to_reference.largest_squared;
  const Distances& worse = deviation.farthest_is_on_reference ? to_mesh : to_reference;
  const double diagonal = bounding_box(other.vertices).diagonal();
  deviation.hausdorff = std::sqrt(worse.largest_squared);
  deviation.farthest_point = worse.farthest;
  deviation.nearest_to_farthest = worse.nearest_to_it;
  deviation.hausdorff_pct_diagonal = 100 * deviation.hausdorff / diagonal;
  const auto of_side = [&](const Distances& side) {
    return OneSidedDistance{100 * std::sqrt(side.largest_squared) / diagonal,
                            100 * std::sqrt(side.sum_squared) / diagonal};
  };
  deviation.from_mesh = of_side(to_reference);
  deviation.from_reference = of_side(to_mesh);
  deviation.rms_pct_diagonal =
      std::max(deviation.from_mesh.rms_pct_diagonal, deviation.from_reference.rms_pct_diagonal);
  return deviation;
}

}  // namespace

Deviation measure_deviation(const SurfaceMesh& mesh, const SurfaceMesh& reference, const DeviationOptions& options) {
  return between(Surface(mesh), Surface(reference), options);
}

Deviation measure_deviation(const TetMesh& mesh, const SurfaceMesh& reference, const DeviationOptions& options) {
  if (mesh.order() == 1)
    return measure_deviation(options.reference_is_of_bodies ? surfaces_of_bodies(mesh) : boundary_surface(mesh),
                             reference, options);
  const double tolerance = flat_enough_of_diagonal * bounding_box(reference.vertices).diagonal();
  const FlatPieces pieces =
      flat_pieces(mesh, tolerance, options.reference_is_of_bodies ? FacesBetween::of_either : FacesBetween::left_out);
  return between(Surface(pieces, mesh), Surface(reference), options);
}

}  // namespace scan2fea
