// cloud_distance TRUTH CLOUD RESULT...: how far surfaces made of a cloud are from what was scanned, all over and where
// the scan has few points, as JSON: one object for each RESULT, in per cent of TRUTH's bounding-box diagonal.
//
// CLOUD has the truth's normals. The spacing at a point of TRUTH is the distance of its sixth nearest measured point,
// without those of the other side of a wall. Where it is 1.5 to 3.5 of its median the truth is undersampled; where it
// is more nothing was measured, and nothing is judged. Distances are taken from both sides, at points spread evenly
// over either surface; those of RESULT belong to where the nearest point of TRUTH does.
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/read_cloud.hpp"
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/splitmix64.hpp"
#include "preproc/surface/kernel/point_neighbours.hpp"
#include "quality/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <vector>

namespace {

using namespace scan2fea;

constexpr std::size_t samples_a_side = 50'000;
constexpr std::size_t most_neighbours = 32, counted_neighbours = 6;
constexpr double least_undersampled = 1.5, most_undersampled = 3.5;  // of the median spacing
constexpr double other_side = -0.5;                                  // cosine between normals: 120 degrees

enum class Sampling { dense, undersampled, none };

struct Samples {
  std::vector<Vec3> points, normals;
};

double unit_random(std::uint64_t index) {
  return static_cast<double>(splitmix64(index) >> 11) * 0x1p-53;
}

// One in each of equal parts of the area.
Samples spread_over(const SurfaceMesh& mesh) {
  std::vector<double> area_up_to{0};
  for (const Triangle& t : mesh.triangles) area_up_to.push_back(area_up_to.back() + area_vector(mesh, t).norm() / 2);
  if (!(area_up_to.back() > 0)) throw std::runtime_error("a surface without area");
  Samples samples;
  for (std::size_t i = 0; i < samples_a_side; ++i) {
    const double area = area_up_to.back() * (static_cast<double>(i) + unit_random(3 * i)) / samples_a_side;
    const auto above = std::upper_bound(area_up_to.begin() + 1, area_up_to.end() - 1, area);
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(above - area_up_to.begin() - 1)];
    const double r = std::sqrt(unit_random(3 * i + 1)), s = unit_random(3 * i + 2);
    samples.points.push_back((1 - r) * mesh.vertices[t[0]] + r * (1 - s) * mesh.vertices[t[1]] +
                             r * s * mesh.vertices[t[2]]);
    samples.normals.push_back(area_vector(mesh, t).normalized());
  }
  return samples;
}

std::vector<Sampling> sampling_at(const Samples& truth, const PointCloud& cloud) {
  const PointNeighbours measured(cloud.points);
  std::vector<double> spacing;
  for (std::size_t i = 0; i < truth.points.size(); ++i) {
    std::array<PointNeighbours::Neighbour, most_neighbours> room;
    std::size_t counted = 0;
    double distance = 0;
    for (const auto& near : measured.nearest(truth.points[i], room)) {
      distance = near.distance;
      if (cloud.normals[near.point].dot(truth.normals[i]) > other_side && ++counted == counted_neighbours) break;
    }
    spacing.push_back(distance);
  }
  std::vector<double> sorted = spacing;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  std::vector<Sampling> result;
  for (const double s : spacing)
    result.push_back(s < least_undersampled * *middle  ? Sampling::dense
                     : s > most_undersampled * *middle ? Sampling::none
                                                       : Sampling::undersampled);
  return result;
}

struct Distances {
  std::vector<double> values;

  double rms() const {
    double sum = 0;
    for (const double d : values) sum += d * d;
    return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
  }
  double quantile(double share) {
    if (values.empty()) return 0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  }
};

void print_figures(const SurfaceMesh& result, const TriangleTree& on_truth, const Samples& truth,
                   const std::vector<Sampling>& sampling, double per_cent) {
  const TriangleTree on_result(result);
  const PointNeighbours near_truth(truth.points);
  Distances all, undersampled;
  const auto add = [&](const TriangleTree& tree, const Vec3& p, Sampling here) {
    if (here == Sampling::none) return;
    all.values.push_back(std::sqrt(tree.closest(p).squared_distance) / per_cent);
    if (here == Sampling::undersampled) undersampled.values.push_back(all.values.back());
  };
  for (std::size_t i = 0; i < truth.points.size(); ++i) add(on_result, truth.points[i], sampling[i]);
  for (const Vec3& p : spread_over(result).points) {
    std::array<PointNeighbours::Neighbour, 1> room;
    add(on_truth, p, sampling[near_truth.nearest(p, room).front().point]);
  }
  const auto share = static_cast<double>(std::ranges::count(sampling, Sampling::undersampled));
  std::printf(
      "{\"undersampled_pct\": %.4g, \"undersampled_rms\": %.6g, \"undersampled_p99\": %.6g, \"rms\": %.6g, "
      "\"p99\": %.6g}",
      100 * share / static_cast<double>(sampling.size()), undersampled.rms(), undersampled.quantile(0.99), all.rms(),
      all.quantile(0.99));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: cloud_distance TRUTH CLOUD RESULT...\n");
    return 2;
  }
  try {
    const SurfaceMesh truth = read_surface(argv[1]);
    const PointCloud cloud = read_cloud(argv[2]);
    if (cloud.normals.empty()) throw std::runtime_error("the cloud has no normals");
    const TriangleTree on_truth(truth);
    const Samples samples = spread_over(truth);
    const std::vector<Sampling> sampling = sampling_at(samples, cloud);
    for (int i = 3; i < argc; ++i) {
      std::fputs(i == 3 ? "[" : ",\n ", stdout);
      print_figures(read_surface(argv[i]), on_truth, samples, sampling, bounding_box(truth.vertices).diagonal() / 100);
    }
    std::puts("]");
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "cloud_distance: %s\n", e.what());
    return 1;
  }
}
