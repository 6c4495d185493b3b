// The triangles of the lattice that the fields have laid on the scan.
// Source: Jakob et al. (2015), section 5 (edge collapses by position), with faces taken from the scan's triangles.
#pragma once

#include "preproc/surface/position_field.hpp"
#include "preproc/surface/refined_scan.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

struct ExtractedLattice {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> vertex_of_node;  // per vertex of the refined scan, the vertex of `mesh` that it belongs to
  bool manifold = false;                      // closed and manifold; where false, `mesh` is what there is
};

// Nodes that share a lattice point become one vertex, at the mean of their lattice points; each triangle of the scan
// with corners in three of them a face. Joins are made in the order of how well positions agree; those of lattice
// points more than 0.6 edge lengths apart are refused, and parts of less than 0.3 of a cell go to their nearest
// neighbour. Where faces do not meet as on a surface, the smallest part there goes the same way, and so on. Not
// guaranteed: genus and components (a limb thinner than an edge length is cut); the caller compares them. Precondition:
// graph.levels[0] is the refined scan's. Nearly linear; deterministic.
ExtractedLattice extract_lattice(const RefinedScan& scan, const GraphLevel& graph, const OrientationField& orientation,
                                 const PositionField& position);

}  // namespace scan2fea
