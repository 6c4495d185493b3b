// The scan cut open along its creases and borders: what every stage sees that must not reach across them.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"

#include <limits>
#include <vector>

namespace scan2fea {

// How far chords of the result may be from the curves, model units: at least, and at most on coarse meshes.
struct CurveTolerance {
  double least = 0;
  double largest = std::numeric_limits<double>::infinity();
};

struct FeatureScan {
  // `sharp`: edges of the scan, see find_features. Keeps a reference to the scan, which must outlive it. Nearly linear.
  // `held_border`: see below.
  FeatureScan(const SurfaceMesh& scan, std::vector<FeatureEdge> sharp, const CurveTolerance& tolerance,
              std::vector<bool> held_border = {});

  // Whether there is anything to keep; without, the scan itself serves as well.
  bool empty() const { return sharp.empty() && border.empty(); }

  const SurfaceMesh& scan;
  std::vector<FeatureEdge> sharp;   // sorted
  std::vector<FeatureEdge> border;  // sorted
  CurveTolerance tolerance;
  // Per vertex of the scan, whether it is a vertex of the result where it lies on the border, which then has no others:
  // another surface has them already. Empty: the border is sampled as the sizing asks for.
  std::vector<bool> held_border;
  CutSurface cut;      // along the sharp edges; without features, nothing
  Components patches;  // of cut.mesh
};

}  // namespace scan2fea
