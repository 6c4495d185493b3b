// cloud_outliers TRUTH CLOUD...: what `reconstruct` leaves out of clouds whose outliers are known, and what surface it
// makes of the rest, as JSON: one object for each CLOUD, an XYZ file of make_cloud, whose last column is 1 for
// outliers. Gone are outliers that are no vertex of the surface; dropped true points that are said to be outliers, or
// lie off the surface by half of the spacing. Told apart can be those that lie off TRUTH by three standard deviations
// of the true points: nearer ones are what noise looks like. The volume is that after repair, over TRUTH's, less 1.
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/read_surface.hpp"
#include "preproc/surface/reconstruction/reconstruct.hpp"
#include "preproc/surface/repair/repair.hpp"
#include "quality/triangle_measures.hpp"
#include "quality/triangle_tree.hpp"
#include "quality/validity.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace scan2fea;

struct KnownCloud {
  PointCloud cloud;
  std::vector<bool> is_outlier, is_plain;  // plain: an outlier that is none of noise
};

// By distances from the truth.
void find_plain(const TriangleTree& truth, KnownCloud& known) {
  constexpr double deviations = 3;
  std::vector<double> distance;
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < known.is_outlier.size(); ++i) {
    distance.push_back(std::sqrt(truth.closest(known.cloud.points[i]).squared_distance));
    if (known.is_outlier[i]) continue;
    squares += distance[i] * distance[i];
    ++count;
  }
  const double sigma = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(count, 1)));
  for (std::size_t i = 0; i < distance.size(); ++i)
    known.is_plain.push_back(known.is_outlier[i] && distance[i] > deviations * sigma);
}

KnownCloud read_known(const char* path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(std::string("cannot read ") + path);
  KnownCloud known;
  for (std::string line; std::getline(file, line);) {
    std::istringstream row(line);
    Vec3 p;
    row >> p[0] >> p[1] >> p[2];
    known.cloud.points.push_back(p);
    known.is_outlier.push_back(line.back() == '1');
  }
  return known;
}

struct Shares {
  double gone_pct = 0, plain_gone_pct = 0, plain_pct = 0, dropped_pct = 0;
};

Shares shares_of(const KnownCloud& known, const ReconstructResult& result) {
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  std::vector<Vec3> vertices = result.surface.vertices, outliers = result.outliers;
  std::ranges::sort(vertices, less);
  std::ranges::sort(outliers, less);
  const TriangleTree tree(result.surface);
  std::size_t all = 0, gone = 0, plain = 0, plain_gone = 0, dropped = 0;
  for (std::size_t i = 0; i < known.is_outlier.size(); ++i) {
    const Vec3& p = known.cloud.points[i];
    const bool is_named = std::ranges::binary_search(outliers, p, less);
    all += known.is_outlier[i];
    plain += known.is_plain[i];
    if (known.is_outlier[i]) {
      const bool is_gone = is_named || !std::ranges::binary_search(vertices, p, less);
      gone += is_gone;
      plain_gone += is_gone && known.is_plain[i];
    } else {
      dropped += is_named || !tree.closest_within(p, 0.5 * result.spacing);
    }
  }
  const auto share = [](std::size_t part, std::size_t whole) {
    return 100 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
  };
  return {share(gone, all), share(plain_gone, plain), share(plain, all), share(dropped, known.is_outlier.size() - all)};
}

void print_figures(const KnownCloud& known, double volume) {
  const std::clock_t start = std::clock();
  ReconstructResult result = reconstruct(known.cloud);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const Shares shares = shares_of(known, result);
  SurfaceMesh surface = result.surface;
  const RepairResult repaired = repair(surface);
  const SurfaceValidity validity = check_validity(surface);
  std::printf(
      "{\"outliers_gone_pct\": %.4g, \"plain_gone_pct\": %.4g, \"plain_pct\": %.4g, \"true_dropped_pct\": %.4g, "
      "\"volume_pct\": %.4g, \"bodies\": %zu, \"genus\": %d, "
      "\"edge_ratio\": %.4g, \"kept\": %zu, \"outliers\": %zu, \"merged\": %zu, \"noise\": %.4g, \"spacing\": %.4g, "
      "\"bridges\": %zu, \"seconds\": %.3g}",
      shares.gone_pct, shares.plain_gone_pct, shares.plain_pct, shares.dropped_pct,
      100 * (enclosed_volume(surface) / volume - 1), repaired.bodies, validity.genus.value_or(-1),
      measure_triangles(surface).edge_ratio.mean, result.kept, result.outliers.size(), result.merged, result.noise,
      result.spacing, result.bridges.size(), seconds);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: cloud_outliers TRUTH CLOUD...\n");
    return 2;
  }
  try {
    const SurfaceMesh truth = read_surface(argv[1]);
    const TriangleTree tree(truth);
    const double volume = std::abs(enclosed_volume(truth));
    for (int i = 2; i < argc; ++i) {
      std::fputs(i == 2 ? "[" : ",\n ", stdout);
      try {
        KnownCloud known = read_known(argv[i]);
        find_plain(tree, known);
        print_figures(known, volume);
      } catch (const Error& error) {
        std::printf("{\"refused\": \"%s\"}", error.parts().what.c_str());
      }
    }
    std::puts("]");
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "cloud_outliers: %s\n", e.what());
    return 1;
  }
}
