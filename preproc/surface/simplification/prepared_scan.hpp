// A scan with its creases and borders, made ready to be simplified again and again.
#pragma once

#include "preproc/surface/features/feature_scan.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/sizing/sizing_field.hpp"

#include <optional>
#include <vector>

namespace scan2fea {

// The scan, and what the stages after the lattice ask of it: made when the first of them does, since beside the graph
// of the fields it would be the peak of the memory.
class PreparedScan {
 public:
  // `sharp`: its creases.
  PreparedScan(const SurfaceMesh& surface, std::vector<FeatureEdge> sharp, const CurveTolerance& tolerance_of_curves)
      : mesh(surface), features_(std::in_place, surface, std::move(sharp), tolerance_of_curves) {}

  const ReferenceSurface& reference() {
    if (!reference_) {
      if (has_features())
        reference_.emplace(*features_);
      else
        reference_.emplace(mesh);
    }
    return *reference_;
  }
  const FeatureScan& features() const { return *features_; }
  bool has_features() const { return !features_->empty(); }  // creases or borders
  bool has_creases() const { return !features_->sharp.empty(); }
  bool is_closed() const { return features_->border.empty(); }

  // Edge lengths that the sizing asks for, per vertex.
  std::vector<double> wanted_lengths(const SizingOptions& sizing) const {
    return compute_sizing_field(mesh, sizing, has_features() ? &features_->cut : nullptr).edge_length;
  }

  // From here on there are only these.
  void keep_creases(std::vector<FeatureEdge> sharp) {
    reference_.reset();
    features_.emplace(mesh, std::move(sharp), CurveTolerance(features_->tolerance));
  }

  // What the reference's vertices have, by vertex of the scan: of the copies at a crease, the one that `wins`.
  template <class Wins>
  std::vector<double> by_vertex(std::vector<double> of_reference, const Wins& wins) const {
    const std::vector<std::uint32_t>& vertex = features_->cut.vertex_of_copy;
    for (std::size_t c = mesh.vertices.size(); c < of_reference.size(); ++c)
      of_reference[vertex[c]] = wins(of_reference[vertex[c]], of_reference[c]);
    of_reference.resize(mesh.vertices.size());
    return of_reference;
  }

  const SurfaceMesh& mesh;

 private:
  std::optional<FeatureScan> features_;
  std::optional<ReferenceSurface> reference_;
};

}  // namespace scan2fea
