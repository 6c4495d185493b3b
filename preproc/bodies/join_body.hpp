// One body joined to those that are joined already.
#pragma once

#include "preproc/bodies/body_complex.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace scan2fea {

// What was known when a body was joined, or when that failed.
struct JoinHints {
  double tolerance = 0;                             // up to which surfaces touched
  std::optional<double> closing = {};               // a distance, gap or overlap, above it
  bool is_narrow = false;                           // what touches is but a strip or a speck
  bool leaves_gap = false;                          // it is a gap, which may also stay
  std::uint32_t first = no_body, second = no_body;  // between these two
};

// `added`: the number of the body among `bodies`, of which those before it are in the complex. Throws NotMeshable, as
// join_bodies does, without advice; what crosses, or does not close, is not found.
void join_body(BodyComplex& complex, std::span<const Body> bodies, std::uint32_t added, const JoinOptions& options,
               JoinHints& hints);

}  // namespace scan2fea
