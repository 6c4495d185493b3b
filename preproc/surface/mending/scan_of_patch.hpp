// The part of a scan for which a patch of a surface answers (refinement_patch.hpp), however the patch changes.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "quality/deviation_bound.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace scan2fea {

class ScanOfPatch {
 public:
  // `scan_faces`: of the scan, around the patch; at least one. `frozen`: the surface around the patch; `whole`: both,
  // the patch's faces first. `edge`: mean of the patch. `limit`: of the deviation. About 0.3 ms a thousand scan faces.
  ScanOfPatch(const SurfaceMesh& scan, const std::vector<std::uint32_t>& scan_faces, const SurfaceMesh& patch,
              const SurfaceMesh& frozen, const SurfaceMesh& whole, double edge, double limit);
  ScanOfPatch(const ScanOfPatch&) = delete;

  // All that is around.
  const DeviationReference& reference() const { return *reference_; }

  // What the surface around is too far from, and the patch nearer to: its vertices, and centroids between them.
  const SurfaceMesh& answered() const { return answered_; }
  const std::vector<Vec3>& to_answer() const { return to_answer_; }

  // What the patch is fitted to: the faces that lie on it. Nothing where none does.
  const std::optional<ReferenceSurface>& fit() const { return fit_; }
  // Per vertex of it, one of the patch that is near.
  const std::vector<std::uint32_t>& start_of_fit() const { return start_of_fit_; }

 private:
  SurfaceMesh scan_, answered_, fit_part_;
  std::optional<DeviationReference> reference_;
  std::vector<Vec3> to_answer_;
  std::vector<std::uint32_t> start_of_fit_;
  std::optional<ReferenceSurface> fit_;
};

// The faces with the vertices that they use; `vertices` says which of the mesh's each was, and may hold some already.
SurfaceMesh part_of(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& faces,
                    std::vector<std::uint32_t>& vertices);

}  // namespace scan2fea
