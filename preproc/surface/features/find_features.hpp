// The sharp edges of a scan: where the surface has a crease that the result must keep.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/crease_support.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace scan2fea {

struct FeatureOptions {
  // Edges whose faces' normals differ by more are sharp, degrees, 0 to 180; unset: none is. 40: a fillet or a cylinder
  // of 12 facets stays smooth, a chamfer of 45° does not.
  std::optional<double> angle_deg = 40;
  // Edges above this continue a chain of sharp ones where it ends, in its direction, degrees; at most angle_deg. 20:
  // creases that run out on a part do so gradually, and facets of usual fineness are below.
  double continuation_angle_deg = 20;
  // Chains that end freely and are shorter are noise, as a fraction of the bounding box's diagonal, 0 to 1. Loops and
  // chains between two others stay on a clean scan; the rim of a small hole is short. 0.04: noise of 0.1 % leaves
  // chains of up to about 0.03 on a scan of 10,000 triangles.
  double shortest_chain_of_diagonal = 0.04;
};

struct Features {
  std::vector<FeatureEdge> edges;  // sharp interior edges, sorted
  double noise = 0;                // estimated standard deviation of the scan's vertices along normals, model units
  std::vector<UnsupportedCreases> dropped;  // sharp edges that are no creases of a part; see judge_creases
};

// Edges are judged by the normals of their two faces; where the scan's noise would tilt faces by several degrees, these
// are filtered first (Zheng et al., "Bilateral Normal Filtering for Mesh Denoising", TVCG 2011: the local scheme).
// The noise is the median residual of vertices from quadrics through their two rings, so at most half of them may lie
// near creases. Precondition: oriented, manifold, with or without borders. Linear but for a sort; serial.
// What looks like a fold, a rounding or noise is left out (see judge_creases).
// Not guaranteed: that chains are closed or end at one another; creases between normals that differ by less than about
// twice what noise leaves after filtering.
Features find_features(const SurfaceMesh& scan, const FeatureOptions& options = {});

}  // namespace scan2fea
