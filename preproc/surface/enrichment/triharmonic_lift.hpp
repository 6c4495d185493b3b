// Heights of points between measured ones, from the smoothest surface through these.
#pragma once

#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <vector>

namespace scan2fea {

struct TriharmonicOptions {
  // How strongly measured points are held, over the energy of a bend of one edge; none: they stay where they are. About
  // 5 where noise is a twentieth of the spacing.
  double hold = 0;
  // Solves, each with the shape of triangles that the one before has left. The second gains a tenth, a third nothing.
  int solves = 2;
  // Per vertex; none: nowhere. The surface need not be smooth across these. They stay.
  std::vector<bool> creases;
};

// Moves the vertices marked `free` to where the integral of |grad Laplace x|^2 + 0.1 |Laplace x|^2 (lengths over the
// mean edge at the free vertices) is least, with cotangent weights at least 0; the other vertices stay. Vertices marked
// `measured`, where hold > 0, are free as well and pulled to where they are. Free vertices on a border stay. Normal
// equations by sparse Cholesky: about 50 microseconds a free vertex. Not guaranteed: that no face turns over.
void triharmonic_lift(HalfedgeMesh& mesh, const std::vector<bool>& free, const std::vector<bool>& measured,
                      const TriharmonicOptions& options);

}  // namespace scan2fea
