// Edge lengths that a lattice along the orientation field can actually have.
#pragma once

#include "preproc/surface/lattice/orientation_field.hpp"

namespace scan2fea {

struct ScaleRelaxationOptions {
  int cycles = 3;            // V-cycles, 1 or more
  double screening = 0.02;   // pull towards the given lengths, per squared edge length; 0.003 (weak) to 1 (strong)
  double most_change = 0.6;  // of ln h
};

// The orientation field has turned where singularities and bends ask for it; on a lattice that is conformal its turning
// theta and the edge length h go together, grad ln h = (d theta/dy, -d theta/dx). Solves for the ln h that comes
// nearest to that in the least-squares sense while staying near the given one, and sets graph.levels[*].log_length to
// it; on features the given one stays. The lattice then has fewer irregular vertices, at lengths that differ from the
// given ones by up to e^most_change. Multigrid on the graph's hierarchy, all levels of a cycle corrected in turn
// (solved level by level from the coarsest, the way the fields are, it diverges). Deterministic; linear.
void relax_scale(FieldGraph& graph, const OrientationField& orientation, const ScaleRelaxationOptions& options = {});

}  // namespace scan2fea
