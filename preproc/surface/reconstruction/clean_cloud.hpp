// A cloud as it comes from scanners, made fit for a surface through its points.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace scan2fea {

struct CleanedCloud {
  std::vector<Vec3> points;         // no two in one place, neighbours in space mostly beside one another
  std::vector<std::uint32_t> from;  // which of the given points each is, or was before it moved
  std::size_t repeated = 0;         // in the place of another
  std::size_t thinned = 0;          // left out since another of their cell stays
  std::size_t merged = 0;           // nearer to another than noise
  std::vector<Vec3> outliers;
  bool has_outliers = false;  // more than what corners look like
  double cell = 0;            // of the thinning, model units; 0: none
  double noise = 0;           // of single points, model units: an estimate
};

// Repeated points go; of more than `most` one in each cell of a grid stays (thinning.hpp), and cells that hold far
// fewer points than those about them go; where noise is larger than the spacing points become the mean of those about
// them; outliers go (outliers.hpp), with all points that they stand for; points that are nearer than four times the
// noise are merged. Points of the two sides of a wall, where `outwards` tells them apart (sided_neighbours.hpp), are
// not merged. Throws NotMeshable where fewer than four points are left, or all are in one place, on a line or in a
// plane. About 100 us a point up to `most`, a microsecond beyond.
CleanedCloud clean_cloud(const std::vector<Vec3>& points, const std::vector<Vec3>& outwards, std::size_t most,
                         const Progress& progress = {});

}  // namespace scan2fea
