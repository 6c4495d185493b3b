// Reads scans of any size: those of more triangles than a chain can hold are thinned while they are read.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/read_cloud.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace scan2fea {

// What a scan is like as it is given.
struct GivenScan {
  std::uint64_t triangles = 0;
  BoundingBox box;
  double area = 0;
  double volume = 0;  // what its faces enclose, if they do
};

struct Thinning {
  GivenScan given;
  std::size_t triangles = 0;  // that are left
  double cell = 0;            // about how far vertices are apart (cluster_seeds.hpp), model units
  // Of the volume within, where no border is left: from that of the given scan, over it. What is cut off of a curved
  // surface, and walls thinner than cells, which are gone.
  std::optional<double> volume_change;
  std::vector<std::string> lost_sets;  // of triangles that are all gone
  double largest_distance = 0;         // bound between the two surfaces
  Vec3 farthest = Vec3::Zero();        // where it is reached
};

struct ThinnedScan {
  NamedScan scan;
  std::optional<Thinning> thinning;  // nothing where the scan is as the file has it
};

// A scan of more triangles than `largest` is thinned to about a quarter of that, so that each vertex stands for many
// and what is left is even; but not to fewer than `needed`. Where noise is too large for cells of that size they get
// ten times as wide as it is, up to four times as wide as they were, and there are fewer.
struct ThinningLimit {
  std::size_t largest = 8'000'000;
  std::function<std::size_t(const GivenScan&)> needed = {};  // without: 0
};

// `read_named_scan` otherwise; clouds are never thinned here. A file that may hold more triangles is gone through three
// times, and memory holds what read_cloud.hpp says of blocks, and 150 bytes for each triangle that is left. Sets of
// triangles are carried. Throws what readers throw, Cancelled, and NotMeshable where nothing is left or more than 5 % of the
// volume goes or comes.
ThinnedScan read_thinned_scan(const std::filesystem::path& path, const ThinningLimit& limit = {},
                              const Progress& progress = {});

}  // namespace scan2fea
