// Points that stand for a surface in an integral over it.
#pragma once

#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/kernel/locate.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

struct SurfaceSamples {
  std::vector<Sample> samples;
  std::vector<std::uint32_t> vertex;  // per sample, a scan vertex near it: where its search on the result starts from
};

// Quadrature points of the scan, exact for quadratics on every triangle: its centroid with 3/4 of its area, its corners
// with 1/12 each. (Scan vertices alone are not enough: a fit to them ripples between them.) Triangles longer than
// `longest_edge` are subdivided for it. Where that makes more than `most` samples, `most` samples of equal weight are
// spread evenly over the area instead.
// Linear in the scan and the samples. Sample order is the scan's, so neighbours in memory are mostly neighbours in
// space.
SurfaceSamples sample_surface(const ReferenceSurface& scan, double longest_edge, std::size_t most);

// So many samples of each triangle, as real numbers: spread evenly over its area, which they share, and the fractions
// over triangles that follow one another.
SurfaceSamples sample_surface(const ReferenceSurface& scan, const std::vector<double>& count_of_triangle);

}  // namespace scan2fea
