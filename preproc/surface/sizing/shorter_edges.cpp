#include "preproc/surface/sizing/shorter_edges.hpp"

#include <algorithm>
#include <cmath>

namespace scan2fea {

ShorterEdges shorter_edges(const Vec3& centre, double longest_edge, double angle_deg, double good_deg) {
  constexpr double reach = 1.5;
  return {{centre, reach * longest_edge}, std::clamp(angle_deg / good_deg, most_shortening, least_shortening)};
}

ShorterEdges shorter_around(const SurfaceMesh& mesh, std::uint32_t face, double factor) {
  const Triangle& t = mesh.triangles[face];
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return {{(a + b + c) / 3, std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()})}, factor};
}

std::vector<ShorterEdges> without_overlaps(std::span<const ShorterEdges> places) {
  std::vector<ShorterEdges> apart;
  for (const ShorterEdges& place : places)
    if (std::none_of(apart.begin(), apart.end(), [&](const ShorterEdges& other) {
          return (place.where.centre - other.where.centre).norm() < other.where.radius;
        }))
      apart.push_back(place);
  return apart;
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

void shorten_by_deviation(const std::vector<double>& deviation, double distance, double least,
                          std::vector<double>& length) {
  constexpr double shortest_edge = 0.5;  // over the distance: shorter ones help nothing
  for (std::size_t v = 0; v < length.size(); ++v) {
    if (deviation[v] <= distance) continue;
    const double factor = std::clamp(std::sqrt(distance / deviation[v]), most_shortening, least);
    length[v] = std::max(factor * length[v], std::min(length[v], shortest_edge * distance));
  }
}

}  // namespace scan2fea
