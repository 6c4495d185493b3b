// Moving all nodes around a poor element at once, to where the worst of the elements around them is best.
//
// One node after the other ends where none can be moved any more by itself; together they still can (on fandisk, ten
// nodes around an element of 25 degrees bring it to 38).
#pragma once

#include "preproc/volume/boundary_ways.hpp"

#include <cstdint>

namespace scan2fea {

class TetComplex;

struct PatchOptions {
  double jacobian_counts = 1;  // times as much as in goal_quality
  double gain = 1.01;          // by which the least quality is to rise
};

// Moves the nodes of the element and of the elements around it; those of the boundary only along their ways, if there
// are any. Minimises the logarithm of the sum of exp(-b q) over all elements that move, q their goal_quality, for b
// from 16 to 64: then little but the worst counts. Kept where the least quality rises enough; returns whether it does.
// some 10 ms.
bool relocate_patch(TetComplex& complex, std::uint32_t bad, const BoundaryWays& ways, const PatchOptions& options = {});

}  // namespace scan2fea
