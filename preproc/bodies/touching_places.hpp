// Where surfaces of joined bodies still have points in common: lines and points at which they touch, or cross.
#pragma once

#include "preproc/bodies/body_complex.hpp"
#include "quality/self_intersections.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

struct TouchingPlace {
  std::uint32_t first = no_body, second = no_body;  // bodies; the same where a body crosses itself
  std::vector<FacePair> faces;  // of the complex, each with one of the first body and one of the second
  double length = 0;            // of the diagonal of its box
  Vec3 at = Vec3::Zero();
};

// One for each two bodies, ascending. The cost of a search for intersections.
std::vector<TouchingPlace> find_touching_places(const BodyComplex& complex);

// Whether the two only touch there: no material of one is in that of the other by more than rounding.
bool only_touch(const TouchingPlace& place, const BodyComplex& complex);

// Moves vertices of the body's surface, as it was before it was joined, inwards by `distance` where it touches.
void draw_back_at(const TouchingPlace& place, const BodyComplex& complex, std::uint32_t body, double distance,
                  SurfaceMesh& surface);

// Whether nearly all of either surface lies on the other, no farther than `tolerance`, and faces the same way.
bool lie_alike(const SurfaceMesh& a, const SurfaceMesh& b, double tolerance);

}  // namespace scan2fea
