// What must not be wrong with a surface that a volume mesher gets.
#pragma once

#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "quality/self_intersections.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

struct SurfaceDefects {
  std::vector<FacePair> crossings;          // see find_self_intersections
  std::vector<std::uint32_t> inverted;      // faces whose normal opposes the scan's all around
  std::vector<std::uint32_t> small_angles;  // faces with an angle under the limit
  double missing_angles_deg = 0;            // sum of what their smallest angles lack

  bool none() const { return crossings.empty() && inverted.empty() && small_angles.empty(); }
  // Whether a volume mesher can take the surface: small angles only cost quality.
  bool meshable() const { return crossings.empty() && inverted.empty(); }
};

// Per face of `mesh`, the vertex of the scan nearest to its centroid on the same side of the body and, with features,
// on its own patch and side of each line.
std::vector<std::uint32_t> scan_vertices_of_faces(const SurfaceMesh& mesh, const ReferenceSurface& scan);
std::vector<std::uint32_t> scan_vertices_of_faces(const SurfaceMesh& mesh, const FeatureNet& net,
                                                  const ReferenceSurface& scan);

// The same without features: `known` ones are taken where they are on the same side and within half an edge, and the
// others alone are searched for; a large scan's tree is not made where there are none.
std::vector<std::uint32_t> scan_vertices_of_faces(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& known,
                                                  const ReferenceSurface& scan);

// A face counts as inverted if its normal opposes the scan's everywhere within an edge length of its centroid: where
// the scan turns over in less than that, as in the folds of an ear, no face can follow it and none is wrong. `near`:
// scan_vertices_of_faces, of the mesh or of one whose faces moved little since. About O(n log n).
SurfaceDefects find_defects(const SurfaceMesh& mesh, const ReferenceSurface& scan,
                            const std::vector<std::uint32_t>& near, double least_angle_deg);

}  // namespace scan2fea
