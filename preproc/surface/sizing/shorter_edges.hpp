// Shorter edges around places where a result came out badly: one rule for all that ask for them.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <span>
#include <vector>

namespace scan2fea {

// The most and the least that edges are shortened by from one result to the next. By less, the next lattice is much the
// same; by more, one bad place makes the count grow by more than it needs.
inline constexpr double most_shortening = 0.5, least_shortening = 0.75;

// Where edges are to be `factor` times as long as they were.
struct ShorterEdges {
  Ball where;
  double factor;
};

// Around a triangle or a tetrahedron with this smallest angle where `good_deg` was wanted: the shorter the worse it is,
// within one and a half of its longest edge, so that its neighbours are shortened too.
ShorterEdges shorter_edges(const Vec3& centre, double longest_edge, double angle_deg, double good_deg);

// Around a face of a mesh that nothing else helps.
ShorterEdges shorter_around(const SurfaceMesh& mesh, std::uint32_t face, double factor);

// Without those whose centre lies in one before. O(n x what is left).
std::vector<ShorterEdges> without_overlaps(std::span<const ShorterEdges> places);

// Multiplies the lengths of the scan's vertices at these places, each by the smallest factor there. O(places x
// vertices).
void shorten_around(std::span<const ShorterEdges> places, const SurfaceMesh& scan, std::vector<double>& edge_length);

// Shorter edges where the deviation is too large; it goes with their square. By at least `least` where patches were
// tried there in vain. Both per vertex of the scan, model units.
void shorten_by_deviation(const std::vector<double>& deviation, double distance, double least,
                          std::vector<double>& length);

}  // namespace scan2fea
