// What the fit of shape_fit.hpp is told, and what it tells.
#pragma once

#include "preproc/surface/kernel/vertex_constraint.hpp"
#include "preproc/surface/placement/shape_energy.hpp"

#include <cstddef>
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
  // By face, a corner of the scan's face on which its centroid was located. Nothing where only the scan's samples were.
  std::vector<std::uint32_t> scan_vertex_of_face;
  std::size_t samples = 0;
  double largest_step = 0;          // of a vertex, in the last sweep
  double fidelity_of_diagonal = 0;  // that the last round had
};

}  // namespace scan2fea
