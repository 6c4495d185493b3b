#include "preproc/surface/sizing/shorter_edges.hpp"

#include <algorithm>

namespace scan2fea {

ShorterEdges shorter_edges(const Vec3& centre, double longest_edge, double angle_deg, double good_deg) {
  constexpr double reach = 1.5;
  return {{centre, reach * longest_edge}, std::clamp(angle_deg / good_deg, most_shortening, least_shortening)};
}

void shorten_around(std::span<const ShorterEdges> places, const SurfaceMesh& scan, std::vector<double>& edge_length) {
  for (std::size_t v = 0; v < edge_length.size(); ++v) {
    double factor = 1;
    for (const ShorterEdges& place : places)
      if ((scan.vertices[v] - place.where.centre).squaredNorm() < place.where.radius * place.where.radius)
        factor = std::min(factor, place.factor);
    edge_length[v] *= factor;
  }
}

}  // namespace scan2fea
