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

// The gradient at node i, in its frame, of what rises by rise(j) to its neighbour j: by least squares over the edges,
// damped by 0.1 % so that edges that hardly span the plane do not make it large; 0 where they do not at all.
template <class Rise>
Complex gradient_at(const GraphLevel& level, std::size_t i, const TangentFrame& frame, const Rise& rise) {
  double xx = 0, xy = 0, yy = 0, bx = 0, by = 0;
  for (std::uint32_t e = level.first[i]; e < level.first[i + 1]; ++e) {
    const std::uint32_t j = level.neighbours[e];
    const Complex d = frame.coordinates(level.positions[j] - level.positions[i]);
    const double difference = rise(j);
    const auto w = static_cast<double>(level.weights[e]);
    xx += w * d.real() * d.real();
    xy += w * d.real() * d.imag();
    yy += w * d.imag() * d.imag();
    bx += w * d.real() * difference;
    by += w * d.imag() * difference;
  }
  const double damping = 1e-3 * (xx + yy);
  xx += damping;
  yy += damping;
  const double determinant = xx * yy - xy * xy;
  return determinant > 0 ? Complex(yy * bx - xy * by, xx * by - xy * bx) / determinant : Complex(0, 0);
}

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
