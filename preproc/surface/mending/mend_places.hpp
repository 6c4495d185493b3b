// Mends places of a made surface where they are, each by a patch (refinement_patch.hpp) whose rim stays: instead of
// another lattice of the whole.
//
// Folds are opened, edges flipped and split and vertices fitted until no angle of a triangle, and no half of an angle
// between two faces, which bounds that of tetrahedra, is below the least; where that is in vain, with shorter edges,
// but not where the place lacks so little that the least shortening is wanted: what they insert costs more than that. A
// patch is kept only where nothing crosses, angles are better as a whole, none between faces gets worse, and the
// deviation stays within the limit or no larger than it was.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/mending/defects.hpp"
#include "preproc/surface/sizing/shorter_edges.hpp"
#include "quality/triangle_tree.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

struct MendPlacesOptions {
  double limit = 0;  // of the deviation, two-sided, model units; above 0. A patch that was farther gets no farther.
  // See ShapeFitOptions.
  double fidelity_of_diagonal = 0.0016;
  // Of triangles, and of halves of the angles between faces, but for those between lines of the part; in (0, 60).
  double least_angle_deg = 30;
};

struct MendPlacesResult {
  std::size_t mended = 0;    // patches that are better than they were
  std::size_t inserted = 0;  // vertices
  std::size_t left = 0;      // places that have not what was asked for
};

// Places that overlap one after the other, in the order given; see PatchMender for the scan's tree. `mesh` is to be
// closed, manifold and free of self-intersections, and so it is afterwards, with the same genus and components;
// vertices on the net's lines stay where they are, and new ones come between them. The net's patches of faces are
// emptied. The volume changes a little (see preserve_volume.hpp). A pass over the mesh and some tens to hundreds of ms
// a place, by its faces and the scan's there. Throws WrongUsage for options out of range, Cancelled.
MendPlacesResult mend_places(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                             const TriangleTree* scan_tree, std::span<const ShorterEdges> places,
                             const MendPlacesOptions& options, const Progress& progress = {});

// The same where faces cross or are inverted, as a lattice leaves a few: `mesh` may do so at these defects. Any sound
// state is better, however far it is, so that a few places do not cost the rest of the surface. Nothing crosses any
// more where no place is left.
MendPlacesResult mend_tangles(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                              const SurfaceDefects& defects, const MendPlacesOptions& options,
                              const Progress& progress = {});

// These faces and what of the scan is beside them, as far as their longest edge, brought within a deviation, as far
// as it goes. Around that the limit does, and angles are not made smaller than the least, nor than they were.
MendPlacesResult bring_faces_within(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                                    const TriangleTree* scan_tree, std::span<const std::uint32_t> faces,
                                    double deviation, const MendPlacesOptions& options, const Progress& progress = {});

}  // namespace scan2fea
