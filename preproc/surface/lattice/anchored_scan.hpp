// The refined scan with its feature curves sampled: what ties a lattice to the edges of a part.
#pragma once

#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/features/feature_scan.hpp"
#include "preproc/surface/sizing/sizing_field.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace scan2fea {

inline constexpr std::uint32_t no_sample = std::numeric_limits<std::uint32_t>::max();

// A place that becomes a vertex of the result as it is.
struct FeatureSample {
  Vec3 position;
  bool on_border = false;
};

struct NodeTangent {
  std::uint32_t node;
  Vec3 along;  // an edge of a feature that ends at the node, either way
};

// Empty where nothing is to be kept.
struct Anchors {
  std::vector<FeatureSample> samples;
  std::vector<std::uint32_t>
      sample_of_node;                        // per node: on a feature, the nearest sample along it; no_sample elsewhere
  std::vector<NodeTangent> tangents;         // two for each side of each feature edge
  std::vector<std::uint32_t> welded;         // per node, the vertex of the scan before cutting that it is a copy of
  std::vector<std::uint32_t> patch_of_node;  // as FeatureScan::patches numbers them
  FeatureNet net;                            // its vertices are samples; without faces
  std::vector<std::vector<std::uint32_t>> vertices_of_line;  // per line of the net, its points before cutting; closed:
                                                             // the first is not repeated

  bool empty() const { return samples.empty(); }
};

struct AnchoredScan {
  RefinedScan refined;  // cut along the sharp edges; scan_vertex_at is of the vertices of FeatureScan::cut
  Anchors anchors;
  double triangles = 0;  // that the sizing asks for
};

// Curves are sampled at the distances that the sizing asks for, as nearly as corners allow; the distances that they end
// up with then count as the wanted edge lengths there, and gradate into the surface. Samples are vertices of the
// refined scan. Precondition: !scan.empty(). Throws what compute_sizing_field throws. Nearly linear.
AnchoredScan anchor_scan(const FeatureScan& scan, const SizingOptions& sizing, double longest_scan_edge);

}  // namespace scan2fea
