// Moves of vertices, the least that bring a point near to where it should be, or open an edge to a dihedral angle:
// projections onto one constraint. Repeated over all constraints in turn they come to a state that holds them all,
// where there is one near by (Mueller et al., Position Based Dynamics, J. Visual Communication and Image Representation
// 18, 2007, section 3.3).
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/locate.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace scan2fea {

// An edge with its two faces, one of which may belong to another surface that stays as it is.
struct Hinge {
  std::uint32_t face, side;           // of the mesh; the edge is opposite to its corner of this number
  std::optional<std::uint32_t> apex;  // of the face beyond, where that is of the mesh
  Vec3 beyond;                        // area vector of the face beyond

  // Interior dihedral angle, degrees, in (0, 360).
  double angle_deg(const SurfaceMesh& mesh) const;
};

// Brings the point at `at` within `distance` of `to`. Vertices that are `held` stay; a point that others hardly move
// stays, too.
void pull_point(SurfaceMesh& mesh, const std::vector<bool>& held, const Location& at, const Vec3& to, double distance);

// Goes half the way to the wanted interior angle, each vertex by at most `longest_step`.
void open_hinge(SurfaceMesh& mesh, const std::vector<bool>& held, const Hinge& hinge, double wanted_deg,
                double longest_step);

}  // namespace scan2fea
