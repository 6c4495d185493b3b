// The triangles of the lattice that the fields have laid on the scan.
// Source: Jakob et al. (2015), section 5 (edge collapses by position), with faces taken from the scan's triangles.
#pragma once

#include "preproc/surface/lattice/lattice_clusters.hpp"
#include "preproc/surface/lattice/position_field.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// Nodes that share a lattice point become one vertex, at the mean of their lattice points. Joins are made in the order
// of how well positions agree; those of lattice points more than 0.6 edge lengths apart are refused, and parts of less
// than 0.3 of a cell go to their nearest neighbour. Each triangle of the scan with corners in three parts is a face.
// Where faces do not meet as on a surface, the smallest part there goes to its neighbour as well, and so on. Where that
// does not end in a closed manifold whose components have the genera of the scan's (a limb or a handle is thinner than
// an edge length), the parts are contracted edge by edge instead, as far as the link condition allows. That always
// keeps the topology, at the price of a few vertices more than the lattice has there.
// Each sample of a feature is a vertex, its nodes on all sides one part with it, and keeps its place; no two become
// one. Where features are so dense that an edge of the result between two neighbouring samples is missing, that counts
// as not ending in a manifold.
// Precondition: the scan is a manifold, closed but for its features; graph is the finest level of its graph. Nearly
// linear; deterministic.
ExtractedLattice extract_lattice(const RefinedScan& scan, const Anchors& anchors, const FieldGraph& graph,
                                 const OrientationField& orientation, const PositionField& position);

}  // namespace scan2fea
