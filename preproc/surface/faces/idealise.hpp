// Vertices of a scan put onto the shapes that its faces have: what is plane becomes plane, what is round round.
#pragma once

#include "preproc/surface/faces/find_faces.hpp"

#include <cstddef>

namespace scan2fea {

enum class Idealise {
  plane,  // faces that are planes
  all,    // and cylinders, cones, spheres and tori
};

struct IdealiseResult {
  std::size_t moved = 0;  // vertices
  std::size_t left = 0;  // of such faces, that lie farther from their shapes than noise explains: worn or warped places
  double largest_move = 0, rms_move = 0;  // model units
};

// `faces`: of `mesh`, which stays where moves would make it meet itself. Vertices between faces go to where their
// shapes meet; between tangent ones, onto both. O(n log n).
IdealiseResult idealise(SurfaceMesh& mesh, const SurfaceFaces& faces, Idealise what);

}  // namespace scan2fea
