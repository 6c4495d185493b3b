#include "preproc/surface/thinning/read_thinned_scan.hpp"

#include "preproc/mesh/error.hpp"
#include "preproc/mesh/error_text.hpp"
#include "preproc/mesh/scan_file.hpp"
#include "preproc/surface/thinning/cluster_seeds.hpp"
#include "preproc/surface/thinning/vertex_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace scan2fea {
namespace {

class Measured {
 public:
  void add(const SurfaceMesh& block) {
    for (const Triangle& t : block.triangles) {
      if (scan_.area == 0) apex_ = block.vertices[t[0]];
      for (const std::uint32_t v : t) {
        low_ = low_.cwiseMin(block.vertices[v]);
        high_ = high_.cwiseMax(block.vertices[v]);
      }
      const Vec3 normal = area_vector(block, t);
      scan_.area += normal.norm() / 2;
      scan_.volume += normal.dot(block.vertices[t[0]] - apex_) / 6;
    }
    scan_.triangles += block.triangles.size();
  }
  GivenScan scan() const {
    GivenScan scan = scan_;
    if (scan.triangles > 0) scan.box = {low_, high_};
    return scan;
  }

 private:
  GivenScan scan_;
  Vec3 low_ = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high_ = -low_;
  Vec3 apex_ = Vec3::Zero();  // a vertex: that a part lies far from the origin costs no digits
};

// A plane in any direction goes through one and a half cells in the area of a cell's side, on average; two thirds of
// them are seeds, each of which stands for two triangles.
double cell_for(std::size_t triangles, const GivenScan& scan) {
  constexpr double triangles_a_side = 2, smallest_of_diagonal = 1e-6;
  return std::max(std::sqrt(triangles_a_side * scan.area / static_cast<double>(triangles)),
                  smallest_of_diagonal * scan.box.diagonal());
}

// The file read once more, `take` being told of each block. Half of the progress is for either time.
NamedSurface read_again(const ScanFile& file, const GivenScan& given, double done, const Progress& progress,
                        const TakeBlock& take) {
  std::uint64_t seen = 0;
  return file.read_in_blocks([&](const SurfaceMesh& block) {
    seen += block.triangles.size();
    progress("read", done + 0.5 * static_cast<double>(seen) / static_cast<double>(given.triangles));
    take(block);
  });
}

// What is thick because it bends is four times as thick in cells twice as wide; noise stays.
double noise_of(const ClusterSeeds& seeds) {
  const double narrow = seeds.widened(2).thickness(), wide = seeds.widened(4).thickness();
  return std::sqrt(std::max(0.0, (16 * narrow * narrow - wide * wide) / 15));
}

// Dust fills more cells than its area tells, and noise that is as large as they are makes folds of them: both get wider
// ones, these not wider than where the noise was looked at, nor than `needed` triangles are.
ClusterSeeds seeds_for(const ScanFile& file, const GivenScan& given, std::size_t most, std::size_t needed,
                       const Progress& progress) {
  constexpr double usual_cells_a_triangle = 0.75, too_many = 1.5, wider = 1.5;
  const double largest = too_many * usual_cells_a_triangle * static_cast<double>(most);
  ClusterSeeds seeds(given.box, cell_for(most, given));
  read_again(file, given, 0, progress, [&](const SurfaceMesh& block) {
    seeds.add(block);
    while (static_cast<double>(seeds.cells()) > largest) seeds = seeds.widened(wider);
  });
  constexpr double of_noise = 10, widest = 4;
  const double for_needed = cell_for(std::max<std::size_t>(1, needed), given) / seeds.cell();
  const double times = std::min({of_noise * noise_of(seeds) / seeds.cell(), widest, for_needed});
  if (times > 1) seeds = seeds.widened(times);
  seeds.choose();
  return seeds;
}

// Nothing where the given scan has next to no volume of its own: shells that are turned against one another.
std::optional<double> volume_change(const GivenScan& given, const ThinnedSurface& thinned) {
  constexpr double flat = 1e-6;  // of the area to the power of 1.5
  if (!thinned.volume || !(std::abs(given.volume) > flat * std::pow(given.area, 1.5))) return {};
  return *thinned.volume / given.volume - 1;
}

// Leaves no set without triangles, and gives back the names of those that lost them.
std::vector<std::string> carry_sets(std::vector<NamedSet>& sets, const std::vector<std::uint32_t>& origin) {
  std::erase_if(sets, [](const NamedSet& set) { return set.members.empty(); });
  sets = carried_sets(sets, origin);
  std::vector<std::string> lost;
  for (const NamedSet& set : sets)
    if (set.members.empty()) lost.push_back(set.name);
  std::erase_if(sets, [](const NamedSet& set) { return set.members.empty(); });
  return lost;
}

ThinnedScan thin(const ScanFile& file, const GivenScan& given, std::size_t largest, std::size_t needed,
                 const Progress& progress) {
  ClusterSeeds seeds = seeds_for(file, given, std::max(largest / 4, needed), needed, progress);
  const double cell = seeds.cell();
  VertexClusters clusters(std::move(seeds));
  NamedSurface named = read_again(file, given, 0.5, progress, [&](const SurfaceMesh& block) { clusters.add(block); });
  ThinnedSurface thinned = std::move(clusters).surface();
  if (thinned.mesh.triangles.empty())
    throw NotMeshable({.what = "nothing of the scan is wider than the cells to which it is thinned",
                       .where = {},
                       .value = error_text(cell),
                       .limit = {},
                       .advice = "--largest-scan " + std::to_string(given.triangles)});
  const std::optional<double> change = volume_change(given, thinned);
  constexpr double largest_change = 0.05;
  if (change && std::abs(*change) > largest_change)
    throw NotMeshable({.what = "the scan is too thin, or too rough, for the cells to which it is thinned, " +
                               error_text(cell) + " wide: of its volume there comes or goes",
                       .where = {},
                       .value = error_text(100 * *change, 3) + " %",
                       .limit = error_text(100 * largest_change) + " %",
                       .advice = "--largest-scan " + std::to_string(given.triangles)});
  std::vector<std::string> lost_sets = carry_sets(named.face_sets, thinned.origin);
  named.mesh = std::move(thinned.mesh);
  const std::size_t left = named.mesh.triangles.size();
  return {.scan = std::move(named),
          .thinning = Thinning{.given = given,
                               .triangles = left,
                               .cell = cell,
                               .volume_change = change,
                               .lost_sets = std::move(lost_sets),
                               .largest_distance = thinned.largest_distance,
                               .farthest = thinned.farthest}};
}

}  // namespace

ThinnedScan read_thinned_scan(const std::filesystem::path& path, const ThinningLimit& limit, const Progress& progress) {
  // The index by which a strip of PLY grows, where vertices are too many for two bytes.
  constexpr std::size_t shortest_triangle = 4;
  const ScanFile file(path);
  if (file.is_of_points() || file.bytes() / shortest_triangle <= limit.largest)
    return {.scan = file.read(), .thinning = {}};
  Measured measured;
  file.read_in_blocks([&](const SurfaceMesh& block) {
    progress("read", 0);
    measured.add(block);
  });
  const GivenScan given = measured.scan();
  if (given.triangles > limit.largest && !(given.area > 0))
    throw NotMeshable({.what = "the triangles of the scan have no area",
                       .where = {},
                       .value = std::to_string(given.triangles) + " triangles",
                       .limit = {},
                       .advice = "exporting the scan again"});
  const std::size_t needed = limit.needed ? limit.needed(given) : 0;
  if (given.triangles <= std::max(limit.largest, needed)) return {.scan = file.read(), .thinning = {}};
  return thin(file, given, limit.largest, needed, progress);
}

}  // namespace scan2fea
