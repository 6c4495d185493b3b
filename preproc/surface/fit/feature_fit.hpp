// What a fit (shape_fit.hpp) does differently where the scan has features: it works on the mesh cut open along its
// lines, so that each side is fitted to its own side of the scan, and vertices on lines slide along them.
#pragma once

#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/fit/fitter.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/fit/shape_fit_options.hpp"
#include "preproc/surface/kernel/cut_surface.hpp"
#include "preproc/surface/kernel/vertex_constraint.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// The mesh cut open along the lines of its net: what the fitter works on.
class CutMesh {
 public:
  CutMesh(const SurfaceMesh& mesh, const FeatureNet& net);

  SurfaceMesh& mesh() { return cut_.mesh; }
  const std::vector<std::uint32_t>& patch_of_vertex() const { return patch_; }
  std::span<const std::uint32_t> copies(std::uint32_t vertex) const { return copies_[vertex]; }

  // What is given by vertex, by copy. Vertices on lines are not the sweeps' to move.
  ShapeFitOptions options_for(const ShapeFitOptions& options, const ReferenceSurface& scan) const;

 private:
  // Per scan vertex, of the copies of its nearest vertex the one on its own side of the lines.
  void choose_copies(std::vector<std::uint32_t>& nearest, const ReferenceSurface& scan) const;

  CutSurface cut_;
  std::vector<bool> on_line_;
  std::vector<std::vector<std::uint32_t>> copies_;
  std::vector<std::uint32_t> patch_;
};

// Slides all vertices on lines once; corners stay. One after the other, so that the outcome does not depend on threads;
// there are few.
void slide_all(Fitter& fitter, CutMesh& cut, FeatureNet& net, const VertexConstraints& constraints);

}  // namespace scan2fea
