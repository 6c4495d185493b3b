// Spreads the vertices of a mesh over the scan until triangles are nearly equilateral and of the wanted size: the way
// to a good mesh where no lattice can be laid (far fewer triangles than the shape has features, parts of a few cells).
//
// Lloyd's method on the mesh: every vertex goes to the centroid of its Voronoi cell with density h^-4 (the cells of a
// centroidal tessellation then have sizes in proportion to h: Du, Faber, Gunzburger 1999), over-relaxed, and back onto
// the scan; edges are flipped to Delaunay after every sweep, and valences improved now and then (connectivity.hpp).
// Between the passes the sizing is renewed from the measured distance to the scan: without that, tips retreat.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/reference_surface.hpp"

#include <vector>

namespace scan2fea {

struct RelaxOptions {
  // Sweeps of Lloyd's method per pass; 30 to 100. At least 1.
  int sweeps = 40;
  // Passes, between which the sizing is renewed from the measured error; 1 for a sizing that is not to change.
  int passes = 2;
  // Step over that to the centroid; below 2. 1.9 converges about eight times as fast as 1.
  double over_relaxation = 1.9;
  // Sweeps between two improvements of the connectivity.
  int sweeps_per_improvement = 10;
  // Exponent of the renewal: h is divided by (local error / mean error)^this. 0.5 would level the error in one step if
  // it followed h squared; less, since the measured error is noisy.
  double renewal = 0.2;
};

struct RelaxResult {
  std::size_t flips = 0;
  double last_step = 0;             // mean step of the last sweep over the mean edge
  std::vector<double> edge_length;  // per vertex of the mesh, the wanted edge length there
};

// `edge_length`: wanted, per vertex of the scan (see sizing_field.hpp). The number of triangles stays, but for one that
// parity asks for; topology stays. Precondition: a closed or bordered manifold near the scan; vertices on borders stay
// in place. Throws WrongUsage for options out of range, NotMeshable where the mesh is no oriented manifold, Cancelled.
// About 4 ms per 10,000 triangles and sweep on one thread. Deterministic for any number of threads.
// Not guaranteed: that triangles are not inverted where the scan is rougher than the mesh (see guard.hpp). A fit by
// shape_fit.hpp should follow: here the vertices lie on the scan, and so its chords inside of convex parts.
RelaxResult relax(SurfaceMesh& mesh, const ReferenceSurface& scan, std::vector<double> edge_length,
                  const RelaxOptions& options = {}, const Progress& progress = {});

}  // namespace scan2fea
