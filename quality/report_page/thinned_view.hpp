// A surface with fewer triangles, to look at: what a browser turns smoothly.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

struct ThinnedView {
  SurfaceMesh mesh;                   // without vertices that no triangle uses
  std::vector<std::uint32_t> origin;  // per triangle the one of the given surface that it stands for
  bool is_thinned = false;            // otherwise all of them, in their order
};

// At most about `most` triangles: where there are more, vertices in one cell of a grid become one, and triangles whose
// corners then are the same are one (Rossignac and Borrel, 1993). O(n log n).
ThinnedView thinned_view(const SurfaceMesh& mesh, std::size_t most);

}  // namespace scan2fea
