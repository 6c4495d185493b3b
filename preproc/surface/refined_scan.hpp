// The scan, made fine enough to carry a lattice: what the fields of the lattice chain live on.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/sizing_field.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// The same surface as the scan, point by point, with more vertices.
struct RefinedScan {
  SurfaceMesh mesh;
  std::vector<double> edge_length;            // the sizing field, linear along the scan's edges
  std::vector<std::uint32_t> scan_vertex_at;  // where each vertex of the scan went
};

// Halves edges longer than `limit` times the wanted edge length at their middle, until none is: above about 0.7 a cell
// of the lattice may hold no vertex and the result gets holes. Each pass halves all long edges at once, so that both
// sides agree and slivers do not multiply; at most `passes` passes (a cube of 12 triangles needs about 10 for a fine
// lattice). Cost: linear in the result, which for long edges has about 2 (edge / (limit h))^2 triangles for one.
RefinedScan refine_scan(SurfaceMesh scan, const SizingField& sizing, double limit, int passes = 16);

}  // namespace scan2fea
