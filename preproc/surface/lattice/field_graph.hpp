// The graph that the orientation and position fields live on, with its coarser versions.
// Source: Jakob et al., "Instant Field-Aligned Meshes" (SIGGRAPH Asia 2015), section 3.3, with maximal independent sets
// in place of pairs, which coarsen faster and more evenly.
#pragma once

#include "preproc/surface/kernel/tangent_frame.hpp"
#include "preproc/surface/lattice/anchored_scan.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// Per node, on the finest level a vertex of the refined scan. Neighbours of node i are
// neighbours[first[i]] .. neighbours[first[i + 1] - 1]; each edge is there from both its ends, with the same weight.
struct GraphLevel {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;       // unit
  std::vector<double> areas;       // model units squared; their sum is the same on all levels
  std::vector<double> log_length;  // natural logarithm of the wanted edge length
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> neighbours;
  std::vector<float> weights;         // cotangent weights on the finest level, kept positive; sums of them above
  std::vector<std::uint32_t> parent;  // the node of the next coarser level; empty on the coarsest
  // Of nodes on features, or with such below them; both empty without features. The lattice has a point at the anchor's
  // place; the guide is the sixth power of the direction that it runs in, in the node's TangentFrame, times a weight.
  std::vector<std::uint32_t> anchor;  // no_sample elsewhere
  std::vector<Complex> guide;         // 0 elsewhere

  std::size_t size() const { return positions.size(); }

  // The same edge from its other end: of edge e of node i. A search, since degrees are about six.
  std::uint32_t mate(std::uint32_t i, std::uint32_t e) const {
    std::uint32_t m = first[neighbours[e]];
    while (neighbours[m] != i) ++m;
    return m;
  }
};

struct FieldGraph {
  std::vector<GraphLevel> levels;  // finest first
  std::vector<Vec3> anchors;       // places, by sample
};

// A coarse node stands for a member of a maximal independent set and those of its neighbours that are tied to it most
// strongly, none across an angle of more than 70° between normals (so that the two sides of a thin wall or a sharp edge
// do not become one). Coarsening ends at about 100 nodes, or where it stalls.
// Precondition: manifold, with or without borders. Linear; about 130 bytes per triangle of the finest level.
FieldGraph build_field_graph(const RefinedScan& scan, const Anchors& anchors = {});

// The mean of log_length over the members of each coarse node, after the finest level's has changed.
void restrict_log_length(FieldGraph& graph);

}  // namespace scan2fea
