#include "preproc/volume/estimate_tetrahedra.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {

std::size_t estimate_with_lattice(const SurfaceMesh& surface, std::size_t lattice_points) {
  return static_cast<std::size_t>(5.9 * static_cast<double>(lattice_points) +
                                  2.97 * static_cast<double>(surface.vertices.size()));
}

std::size_t estimate_with_tetgen(const SurfaceMesh& surface, const std::optional<double>& max_volume) {
  const auto triangles = static_cast<double>(surface.triangles.size());
  const double volume = std::abs(enclosed_volume(surface));
  const double depth = volume / (surface_area(surface) * mean_edge_length(surface));
  double count = triangles * std::max(1.4, 2.25 + 0.65 * std::log2(std::max(depth, 1e-9)));
  // TetGen splits what is larger: the mean comes out at about half of the largest.
  if (max_volume) count = std::max(count, 1.9 * volume / *max_volume);
  return static_cast<std::size_t>(count);
}

}  // namespace scan2fea
