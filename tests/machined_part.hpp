// A machined part whose every face is known, drawn by OpenCASCADE and meshed by Gmsh, as a scan with or without noise.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace scan2fea::analytic {

struct DrawnFace {
  std::string kind;  // "plane", "cylinder", ...
  double area = 0;
  double radius = 0;  // of a cylinder
  Vec3 axis = Vec3::Zero();
};

struct MachinedPart {
  SurfaceMesh scan;
  std::vector<std::uint32_t> face_of_triangle;
  std::vector<DrawnFace> faces;
};

// A base plate, 80 x 50 x 10, with a boss and its bore of radius 6.5 in z, an upright wall with a bore of radius 4 in
// x, a rib between boss and wall, two bores of radius 3 (one countersunk), a ball-shaped pocket, and fillets: of radius
// 6 at two corners, of 2.5 around the boss's foot, of 3 along the wall's top. 25 faces. `edge`: of the triangles.
// `noise`: standard deviation of each coordinate, over the diagonal of 99.
MachinedPart machined_part(double edge, double noise, std::uint64_t seed = 1);

}  // namespace scan2fea::analytic
