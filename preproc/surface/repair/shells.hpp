// The shells (components) of a surface: which way they face, and which of them are solids, cavities, or nothing.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/repair/repair_result.hpp"

#include <optional>
#include <vector>

namespace scan2fea {

struct Shell {
  std::vector<std::uint32_t> faces;
  BoundingBox box;
  double area = 0;
  double volume = 0;  // signed; of an open one, of the cones from its box's centre over its faces
  bool open = false;  // known only where asked for
};

bool contains(const BoundingBox& outer, const BoundingBox& inner);

// The components of a manifold surface, closed or not, ordered by their lowest face. O(n); to tell which are open costs
// a sort of the edges.
std::vector<Shell> find_shells(const SurfaceMesh& mesh, bool tell_open = false);

// The shell of each of the surface's faces.
std::vector<std::uint32_t> shell_of_faces(const std::vector<Shell>& shells, std::size_t face_count);

// Removes the shells that have a reason to go and logs each under it.
void drop_shells(SurfaceMesh& mesh, const std::vector<Shell>& shells,
                 const std::vector<std::optional<RepairKind>>& reasons, RepairResult& result);

// How often the closed ones of the other shells wind about the middle of the shell's first face of any area: 0 where it
// lies outside of all. O(n) of the shells whose boxes contain its box.
double winding_of_others(const SurfaceMesh& mesh, const std::vector<Shell>& shells, std::size_t shell);

// Whether a shell is closed but for holes that have little area beside it, so that its volume has a meaningful sign:
// the area vectors of a closed surface cancel. A tube is, a hemisphere or a dented sheet is not.
bool nearly_encloses(const SurfaceMesh& mesh, const Shell& shell);

// Turns shells so that those that an even number of others enclose face outwards, and the others inwards: solids,
// cavities, solids in cavities. A shell that only partly lies in another counts as outside, unless it faces inwards
// already. Open shells enclose nothing, and are turned outwards only where their holes are small beside them.
// Precondition: manifold, each shell consistently oriented. Enclosure is told by the winding number (van Oosterom and
// Strackee's solid angles) of up to 16 of a shell's vertices: O(n) for each pair of shells whose boxes are nested,
// nothing for a single shell.
void orient_shells(SurfaceMesh& mesh, bool may_be_open, RepairResult& result);

// Shells of a surface that was properly nested before parts of it were cut, and that bound nothing now: solids within a
// solid, and cavities within none. Drops them. Open shells stay, and bound nothing.
void drop_shells_inside(SurfaceMesh& mesh, bool may_be_open, RepairResult& result);

}  // namespace scan2fea
