// The scan, made fine enough to carry a lattice: what the fields of the lattice chain live on.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/sizing/sizing_field.hpp"

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

// The halving itself. New vertices follow the old ones, their edge lengths those in `edge_length`; triangle f stays a
// part of triangle f. `features` are halved with their edges, and longer than `feature_limit` times the edge length,
// are long: what is to be sampled on them needs a vertex near by.
void halve_long_edges(SurfaceMesh& mesh, std::vector<double>& edge_length, std::vector<FeatureEdge>& features,
                      double limit, double feature_limit, int passes = 16);

// A new vertex on an edge, `part` of the way from its first to its second vertex, 0 < part < 1.
struct EdgeSplit {
  FeatureEdge edge;
  double part;
};

// Puts the vertices there, in the order of the splits; at most one split an edge. Each half of a feature is one.
void split_edges(SurfaceMesh& mesh, std::vector<double>& edge_length, std::vector<FeatureEdge>& features,
                 const std::vector<EdgeSplit>& splits);

// Numbers the vertices anew, neighbours in space near one another (see spatial_order.hpp); the old ones' new numbers.
std::vector<std::uint32_t> order_along_curve(SurfaceMesh& mesh, std::vector<double>& edge_length);

}  // namespace scan2fea
