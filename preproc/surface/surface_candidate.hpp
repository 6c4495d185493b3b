// One surface of given sizes, made of a scan: what `simplify` tries, and mends.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/feature_net.hpp"
#include "preproc/surface/feature_scan.hpp"
#include "preproc/surface/reference_surface.hpp"
#include "preproc/surface/shape_fit.hpp"
#include "preproc/surface/simplify.hpp"

#include <optional>
#include <string>
#include <vector>

namespace scan2fea {

// A closed surface needs four faces; fewer than this and no shape is left of anything.
inline constexpr double fewest_faces = 4;

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

struct Candidate {
  SurfaceMesh mesh;
  FeatureNet net;
  std::size_t crossings_mended = 0;
  std::string failure;          // empty where `mesh` is valid
  std::vector<Vec3> failed_at;  // places of what is wrong
  ShapeFitResult fit;
};

// By the method asked for or, where the lattice fails, by contraction; the result's method and remarks say which, and
// what became of the creases. Exact volume, and nothing that crosses itself. Throws NotMeshable where no way is left.
Candidate make_surface(PreparedScan& scan, const SizingOptions& sizing, const SimplifyOptions& options, Effort effort,
                       SimplifyResult& result, const Progress& progress);

// The largest distances are at a few fins and folds thinner than the triangles, far from all others: these places get
// triangles of their own, so few that the count stays within what was asked for. Where the effort asks for it.
void lower_worst(Candidate& candidate, PreparedScan& scan, Effort effort, SimplifyResult& result,
                 const Progress& progress);

// What bounds the tetrahedra's angles, where that is asked for (see wedges.hpp); what is sharp in the scan stays so.
// Whether something was opened.
bool open_wedges(Candidate& candidate, PreparedScan& scan, const SimplifyOptions& options);

}  // namespace scan2fea
