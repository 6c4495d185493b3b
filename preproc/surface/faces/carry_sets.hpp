// Sets of a scan's triangles on a surface that was made of it.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// Per triangle of `surface` the triangle of `scan` that it stands for. `label`: per triangle of the scan; `lines`:
// edges of the surface that stand for lines of the scan, sorted. A piece of the surface between lines has one label
// where lines run along all borders of labels: that of most of its area, by the scan's triangles nearest to its
// triangles' inner points. A piece of which that is true for less than nine tenths was cut out by no lines, and each
// triangle goes by itself. O(n log n).
std::vector<std::uint32_t> carry_labels(const SurfaceMesh& scan, std::span<const std::uint32_t> label,
                                        const SurfaceMesh& surface, std::span<const FeatureEdge> lines);

}  // namespace scan2fea
