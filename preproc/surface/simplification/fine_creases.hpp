// Creases too fine for the triangles that were asked for first, until the search asks for smaller ones.
#pragma once

#include "preproc/surface/simplification/prepared_scan.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace scan2fea {

class FineCreases {
 public:
  FineCreases() = default;
  // Edges of the scan as it was given, before its faces were parted: those that surfaces are to keep, and those left
  // out; both sorted.
  FineCreases(std::vector<FeatureEdge> kept, std::vector<FeatureEdge> left_out)
      : kept_(std::move(kept)), left_out_(std::move(left_out)) {}

  // The scan with the creases too that triangles of these sizes can keep; they are left out no longer. `edge_length`:
  // per vertex of the scan, model units. Costs what select_features does, and nothing where none is left out.
  PreparedScanPointer with_those_kept_by(std::span<const double> edge_length, const PreparedScanPointer& scan);

  std::size_t left_out() const { return left_out_.size(); }

 private:
  std::vector<FeatureEdge> kept_, left_out_;
};

}  // namespace scan2fea
