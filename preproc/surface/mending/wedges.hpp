// Sharp convex edges that the scan does not have: they halve the tetrahedra's smallest angle.
//
// Where a body is thinner than a triangle is wide (an ear, a hem), two triangles may close on one another over one
// edge. Tetrahedra share the angle between them, so that half of it bounds their own. Opening the wedge costs less
// distance from the scan than the triangles' size costs anyway. The same holds where a few vertices come close to
// others across the body.
#pragma once

#include "preproc/surface/fit/reference_surface.hpp"
#include "preproc/surface/kernel/vertex_constraint.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

struct Wedge {
  std::uint32_t face, other;
  std::uint32_t side;  // of `face`, opposite to its corner of this number
  double angle_deg;    // interior
  double wanted_deg;   // the limit, or the scan's own angle there where that is sharper

  bool lacks() const { return angle_deg < wanted_deg; }
};

struct WedgeOptions {
  // Interior dihedral angles below are opened, 0 to 90: 64 lets the tetrahedra have 32, which is what their
  // optimisation aims at.
  double least_dihedral_deg = 64;
  // Two vertices on either side of a thin place keep this distance, over the edge length there: 0.5 lets the tetrahedra
  // around them have 30 degrees. Where more than a hundredth of the vertices are nearer, the body is a thin wall, and
  // is left so. 0 to 0.6.
  double least_wall = 0.5;
  // Of the triangles around: an opening that makes one smaller, or a smaller one still smaller, is undone.
  double least_angle_deg = 38.5;
  // Restore the scan's volume exactly; off for open surfaces.
  bool keep_volume = true;
  VertexConstraints constraints;
};

struct WedgeResult {
  std::size_t before = 0, after = 0;  // wedges sharper than wanted, and vertices too near across the body
  double sharpest_deg = 180;          // of those left, or 180
  bool opened() const { return after < before; }
};

// The edges sharper than the limit, with the angle wanted of them. `neighbours`: see face_neighbours. The scan counts
// as sharp where its own edges, sharper than the limit, make a line two edges long along the wedge, within two edges of
// its middle, of the mesh or of the scan where these are longer. O(n), and a search in the scan for each of them.
std::vector<Wedge> find_wedges(const SurfaceMesh& mesh, const std::vector<Triangle>& neighbours,
                               const ReferenceSurface& scan, double least_dihedral_deg);

// Moves the vertices within two rings of each wedge and near pair to the minimum of the triangles' shape energy (see
// shape_energy.hpp), the squared lack of dihedral angles and distances, and the squared way from where they were; then
// restores the volume. Connectivity stays. A group of them is left as it was where the opening would cost an angle (see
// options) or make faces cross. Precondition: manifold, free of self-intersections; it has none afterwards either.
// Throws what preserve_volume throws. A sound surface costs one pass and a k-d tree of its vertices.
WedgeResult open_wedges(SurfaceMesh& mesh, const ReferenceSurface& scan, const WedgeOptions& options = {});

}  // namespace scan2fea
