// Triangles cut where a surface departs from another one without a rim.
#pragma once

#include "preproc/bodies/facing_surface.hpp"
#include "preproc/bodies/split_surface.hpp"

#include <vector>

namespace scan2fea {

// Halves triangles that lie on `other` in part until their edges are no longer than `resolution`, and splits these
// edges where the contact ends. Those listed alone, which grow with their parts. For a rounding that leaves a plane:
// after imprint_rims, which does it exactly where there is a rim.
void refine_contact_border(SplitSurface& surface, std::vector<bool>& listed, const FacingSurface& own,
                           const FacingSurface& other, double tolerance, double resolution);

}  // namespace scan2fea
