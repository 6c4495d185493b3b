// The last stage of a simplified surface: finds what is wrong with it and mends that, and only that.
//
// Small angles and inverted faces: each vertex around them goes to the candidate place (towards its neighbours'
// centroid, lowered onto the scan) that most raises the worst signed quality of its star, and edges are flipped for the
// same; then shape and fit are optimised again there, with more weight on shape round by round. Faces that pass through
// one another: pairs that share a vertex are such a tangle too; sheets that cross are pushed apart, each to the side
// on which the scan has it, in small steps until they clear. Then the exact volume is restored, and all is checked
// again.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/kernel/vertex_constraint.hpp"
#include "preproc/surface/mending/defects.hpp"

namespace scan2fea {

struct MendOptions {
  // Faces with a smaller angle are worked on; raising it costs fidelity around them. In [0, 60).
  double least_angle_deg = 35;
  // Of mending and checking; each costs a local optimisation. At least 1.
  int rounds = 8;
  // Restore the scan's volume exactly; off for open surfaces.
  bool keep_volume = true;
  // Of the local optimisation, see ShapeFitOptions; grows by half each round.
  double fidelity_of_diagonal = 0.0016;
  double loosest_fidelity_of_diagonal = 0.05;  // where that growth ends
  VertexConstraints constraints;
  // As of ShapeFitOptions; where absent, a k-d tree finds them when they are needed.
  std::optional<std::vector<std::uint32_t>> nearest_vertex_of_scan_vertex;
  // As a fit without features knows them, or nothing: see scan_vertices_of_faces.
  std::vector<std::uint32_t> scan_vertex_of_face;
};

struct MendResult {
  SurfaceDefects before;
  SurfaceDefects after;     // empty but for small angles where `clean`
  int rounds = 0;           // of mending; the best state is returned
  std::size_t moved = 0;    // vertices that the mending moved, by more than the volume's shift
  double largest_move = 0;  // of one of them, model units
  bool clean() const { return after.meshable(); }
};

// Connectivity may change by flips; counts of vertices and faces, topology and the other vertices stay (but for the
// volume's shift). What cannot be mended is in `after`, and the caller must not pass the surface on as sound.
// Precondition: closed or bordered manifold near the scan. Throws WrongUsage, Cancelled, and what preserve_volume
// throws. A sound surface costs one check: O(n log n).
MendResult mend_surface(SurfaceMesh& mesh, const ReferenceSurface& scan, const MendOptions& options = {},
                        const Progress& progress = {});

// The same with features: vertices on the net's lines stay where they are, and angles between two lines are the part's
// own; options.constraints is not looked at.
MendResult mend_surface(SurfaceMesh& mesh, const FeatureNet& net, const ReferenceSurface& scan,
                        const MendOptions& options = {}, const Progress& progress = {});

}  // namespace scan2fea
