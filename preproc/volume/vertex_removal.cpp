#include "preproc/volume/vertex_removal.hpp"

#include "preproc/volume/tet_quality.hpp"

#include <algorithm>
#include <limits>

namespace scan2fea {

bool VertexRemoval::mend(TetComplex& complex, std::uint32_t bad, double gain) {
  const Tetrahedron corners = complex.element(bad).corners;
  return std::any_of(corners.begin(), corners.end(),
                     [&](std::uint32_t v) { return !complex.fixed(v) && remove(complex, v, gain); });
}

bool VertexRemoval::remove(TetComplex& complex, std::uint32_t vertex, double gain) {
  complex.star(vertex, star_);
  neighbours_.clear();
  double before = std::numeric_limits<double>::infinity();
  for (const std::uint32_t t : star_) {
    before = std::min(before, complex.quality(t));
    for (const std::uint32_t v : complex.element(t).corners)
      if (v != vertex) neighbours_.push_back(v);
  }
  std::sort(neighbours_.begin(), neighbours_.end());
  neighbours_.erase(std::unique(neighbours_.begin(), neighbours_.end()), neighbours_.end());
  const double floor = std::max(before * gain, 0.0);
  return std::any_of(neighbours_.begin(), neighbours_.end(),
                     [&](std::uint32_t into) { return contract(complex, vertex, into, floor); });
}

bool VertexRemoval::contract(TetComplex& complex, std::uint32_t vertex, std::uint32_t into, double floor) {
  fresh_.clear();
  for (const std::uint32_t t : star_) {
    Tetrahedron corners = complex.element(t).corners;
    if (std::find(corners.begin(), corners.end(), into) != corners.end()) continue;
    corners[corner_of(corners, vertex)] = into;
    const double quality = goal_quality(complex.node(corners[0]), complex.node(corners[1]), complex.node(corners[2]),
                                        complex.node(corners[3]), floor);
    if (quality <= floor) return false;
    fresh_.push_back({corners, quality});
  }
  complex.replace(star_, fresh_);
  return true;
}

}  // namespace scan2fea
