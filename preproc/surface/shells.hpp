// The shells (components) of a surface: which way they face, and which of them are solids, cavities, or nothing.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair_result.hpp"

#include <vector>

namespace scan2fea {

struct Shell {
  std::vector<std::uint32_t> faces;
  BoundingBox box;
  double area = 0;
  double volume = 0;  // signed
};

// The components of a manifold surface, closed or not (the volume then means nothing), ordered by their lowest face.
std::vector<Shell> find_shells(const SurfaceMesh& mesh);

// Removes the shells whose mark is not 0 and logs each as `kind`.
void drop_shells(SurfaceMesh& mesh, const std::vector<Shell>& shells, const std::vector<char>& marks, RepairKind kind,
                 RepairResult& result);

// Turns shells so that those that an even number of others enclose face outwards, and the others inwards: solids,
// cavities, solids in cavities. A shell that only partly lies in another counts as outside, unless it faces inwards
// already. Precondition: closed, each shell consistently oriented. Enclosure is told by the winding number (van
// Oosterom and Strackee's solid angles) of up to 16 of a shell's vertices: O(n) for each pair of shells whose boxes are
// nested, nothing for a single shell.
void orient_shells(SurfaceMesh& mesh, RepairResult& result);

// Shells of a surface that was properly nested before parts of it were cut, and that bound nothing now: solids within a
// solid, and cavities within none. Drops them.
void drop_shells_inside(SurfaceMesh& mesh, RepairResult& result);

}  // namespace scan2fea
