// A scan made ready to be simplified again and again.
#pragma once

#include "preproc/surface/features/feature_scan.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/sizing/sizing_field.hpp"
#include "quality/deviation_bound.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace scan2fea {

// Edges of a scan that are lines of every surface made of it, whatever triangles they take: borders of sets.
struct KeptLines {
  std::vector<FeatureEdge> edges;      // sorted
  std::size_t smooth = 0;              // of them, that are no creases
  std::vector<bool> held_border = {};  // see FeatureScan
};

// The scan with the creases that a surface made of it is to keep. It never changes; where a surface can keep only some
// of the creases, another one stands beside it (with_creases). It refers to the meshes, which must outlive it.
class PreparedScan {
 public:
  // `surface` is `scan_given` with smaller faces.
  PreparedScan(const SurfaceMesh& scan_given, const SurfaceMesh& surface, std::vector<FeatureEdge> creases,
               const CurveTolerance& tolerance_of_curves, KeptLines lines = {})
      : given(scan_given),
        mesh(surface),
        lines_(std::move(lines)),
        features_(surface, united(std::move(creases), lines_.edges), tolerance_of_curves, lines_.held_border) {}
  // The same, keeping the surface.
  PreparedScan(const SurfaceMesh& scan_given, std::shared_ptr<const SurfaceMesh> surface,
               std::vector<FeatureEdge> creases, const CurveTolerance& tolerance_of_curves, KeptLines lines = {})
      : PreparedScan(scan_given, *surface, std::move(creases), tolerance_of_curves, std::move(lines)) {
    kept_ = std::move(surface);
  }

  PreparedScan with_creases(std::vector<FeatureEdge> creases) const {
    PreparedScan other(given, mesh, std::move(creases), features_.tolerance, lines_);
    other.kept_ = kept_;
    return other;
  }

  const FeatureScan& features() const { return features_; }
  const std::vector<FeatureEdge>& creases() const { return features_.sharp; }  // and lines
  bool has_features() const { return !features_.empty(); }                     // creases, lines or borders
  bool has_creases() const { return features_.sharp.size() > lines_.smooth; }
  // Sorted creases with the lines.
  std::vector<FeatureEdge> with_lines(std::vector<FeatureEdge> creases) const {
    return united(std::move(creases), lines_.edges);
  }
  bool is_closed() const { return features_.border.empty(); }

  // What the stages after the lattice ask of the scan. The first call makes it, since beside the graph of the lattice's
  // fields it would be the peak of the memory; not for several threads at once.
  const ReferenceSurface& reference() const {
    if (!reference_) {
      if (has_features())
        reference_.emplace(features_);
      else
        reference_.emplace(mesh);
      reference_->measure_by_body();
    }
    return *reference_;
  }

  // The reference's surface, for bounds of the deviation from it; made by the first call, too.
  const DeviationReference& deviation_reference() const {
    if (!deviation_reference_) deviation_reference_ = std::make_shared<const DeviationReference>(reference().mesh);
    return *deviation_reference_;
  }

  // Edge lengths that the sizing asks for, per vertex.
  std::vector<double> wanted_lengths(const SizingOptions& sizing) const {
    return compute_sizing_field(mesh, sizing, has_features() ? &features_.cut : nullptr).edge_length;
  }

  // What the reference's vertices have, by vertex of the scan: of the copies at a crease, the one that `wins`.
  template <class Wins>
  std::vector<double> by_vertex(std::vector<double> of_reference, const Wins& wins) const {
    const std::vector<std::uint32_t>& vertex = features_.cut.vertex_of_copy;
    for (std::size_t c = mesh.vertices.size(); c < of_reference.size(); ++c)
      of_reference[vertex[c]] = wins(of_reference[vertex[c]], of_reference[c]);
    of_reference.resize(mesh.vertices.size());
    return of_reference;
  }

  const SurfaceMesh& given;  // before its faces were parted
  const SurfaceMesh& mesh;

 private:
  static std::vector<FeatureEdge> united(std::vector<FeatureEdge> creases, const std::vector<FeatureEdge>& lines) {
    if (lines.empty()) return creases;
    std::vector<FeatureEdge> all;
    std::ranges::set_union(creases, lines, std::back_inserter(all));
    return all;
  }

  std::shared_ptr<const SurfaceMesh> kept_;  // `mesh`, where nobody else keeps it
  KeptLines lines_;
  FeatureScan features_;
  mutable std::optional<ReferenceSurface> reference_;
  mutable std::shared_ptr<const DeviationReference> deviation_reference_;  // refers to reference_
};

using PreparedScanPointer = std::shared_ptr<const PreparedScan>;

// The same scan with other creases; itself where they are the same.
inline PreparedScanPointer with_creases(const PreparedScanPointer& scan, std::vector<FeatureEdge> creases) {
  creases = scan->with_lines(std::move(creases));
  if (creases == scan->creases()) return scan;
  return std::make_shared<const PreparedScan>(scan->with_creases(std::move(creases)));
}

}  // namespace scan2fea
