// Moves the vertices of a mesh so that its triangles become equilateral and its surface lies on the scan, both at once.
//
// Minimises
//   E = sum over faces F(eta) + n / (A (q d)^2) * sum over samples w r^2,
// with F of shape_energy.hpp, n faces, A the scan's area, d its bounding-box diagonal, w the area that a scan sample
// stands for and r its distance to the mesh. Shape alone slides off the scan, fit alone makes needles; the dial between
// them is q: residuals of q d cost as much as F(eta) = 1. Each round locates all samples anew (locate.hpp), then a few
// Gauss-Seidel sweeps take one 3 x 3 Newton step per vertex, on samples condensed to moments (fit_moments.hpp).
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/kernel/vertex_constraint.hpp"
#include "preproc/surface/placement/shape_energy.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace scan2fea {

struct ShapeFitOptions {
  // q: smaller follows the scan more closely, larger gives better triangles; in (0, 0.1). On the Horse at 12,600
  // triangles the mean edge ratio and the RMS distance (% of d) are 1.081 and 0.0167 for 0.0016, 1.093 and 0.0155 for
  // 0.0012, 1.104 and 0.0149 for 0.001.
  double fidelity_of_diagonal = 0.0012;
  // Where set, q goes with what can be reached: from the third round on it is this times the RMS distance, between
  // fidelity_of_diagonal and 0.01 of the diagonal, and the tail goes with it; set anew in so many rounds. What the
  // triangles are too large for, or noise, no fit can follow: drawn to it hard, they only lose their shape.
  std::optional<double> fidelity_of_residual;
  int rounds_of_dialling = 1;
  // Times that all samples are located anew, at least 1. 5 for speed; after 8 the RMS distance falls by less than 1 %.
  int rounds = 8;
  // Gauss-Seidel sweeps between two locations; at least 1. More than 4 overfits to stale locations.
  int sweeps = 3;
  // Also draw the mesh's own samples to the scan (four a face), not only the scan's to the mesh: takes back bulges
  // where the scan has nothing, which alone make half of the largest distance. Costs a tenth of the time.
  bool both_sides = true;
  // Where set, a sample at distance r weighs 1 + (r / (lift_tail_of_diagonal d))^4, at most `most_lift`: a third off
  // the largest distance for 0.002 in the edge ratio. Lower tails (0.0007) cost shape, and crossings in tight folds.
  std::optional<double> lift_tail_of_diagonal = 0.0015;
  double most_lift = 50;
  // Samples weigh by area, so that the mean error is least: where faces are small, shape then outweighs fit, so far
  // that a few may rise to a spike. Faces below this part of the mean size hold to the scan as those of this size do,
  // for a largest error that is small; 0 to 1.
  double hold_faces_below = 0.25;
  ShapeEnergy shape;
  // Where most vertices are fixed, only the samples around the free ones are looked at, and measured.
  VertexConstraints constraints;
  // Per scan vertex a vertex of the mesh near it, to start the first location from (the lattice extraction knows it);
  // where absent, a k-d tree finds one.
  std::optional<std::vector<std::uint32_t>> nearest_vertex_of_scan_vertex;
};

struct ShapeFitResult {
  // Of the samples, the worse side, when they were located last (before the last sweeps), in model units.
  double rms_distance = 0;
  double largest_distance = 0;
  std::vector<double> largest_distance_of_face;  // by the face that the sample was located on, or is of
  std::size_t samples = 0;
  double largest_step = 0;          // of a vertex, in the last sweep
  double fidelity_of_diagonal = 0;  // that the last round had
};

// Connectivity stays. Precondition: a manifold mesh near the scan whose triangles have areas and are not inverted: eta
// does not see an inverted triangle. Throws WrongUsage for options out of range, InvalidInput for a mesh or scan
// without triangles, Cancelled. Deterministic for any number of threads. Not guaranteed: freedom from
// self-intersections and inverted triangles (see mend_surface.hpp), exact volume (see preserve_volume.hpp).
// Cost per round: O(samples) with a small constant (the samples are capped at 12 a face), a few ms per 10,000 faces
// and sweep.
ShapeFitResult optimise_shape_and_fit(SurfaceMesh& mesh, const ReferenceSurface& scan,
                                      const ShapeFitOptions& options = {}, const Progress& progress = {});

// The same with features: vertices on the net's lines stay on them, and samples of the scan belong to the faces of
// their own patch alone. `scan` is made from the FeatureScan that the net comes from. Places on the lines are renewed.
ShapeFitResult optimise_shape_and_fit(SurfaceMesh& mesh, FeatureNet& net, const ReferenceSurface& scan,
                                      const ShapeFitOptions& options = {}, const Progress& progress = {});

}  // namespace scan2fea
