// What of a result the scanner has seen, and what was made up: filled over holes and gaps, or enriched.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace scan2fea {

// The names that sets of such faces have in every file; no set of a user has them.
inline constexpr const char* filled_set = "FILLED";
inline constexpr const char* enriched_set = "ENRICHED";

enum class FaceOrigin { measured, filled, enriched };

// Of each face of `made`, of which the scanner has seen what lies on `seen`: filled where it does not, by more than a
// fiftieth of its longest edge. O(n log n).
std::vector<FaceOrigin> origins_by_place(const SurfaceMesh& made, const SurfaceMesh& seen);

// Of each face of `made`: that of the nearest face of `from`. O(n log n).
std::vector<FaceOrigin> carried_origins(const SurfaceMesh& made, const SurfaceMesh& from,
                                        const std::vector<FaceOrigin>& of_from);

// Marks the faces of an enriched surface that have a new vertex, and are not filled.
void mark_enriched(const SurfaceMesh& made, std::size_t measured_vertices, std::vector<FaceOrigin>& origins);

// The faces that were made up, as sets; none for an origin that no face has.
std::vector<NamedSet> made_up_sets(const std::vector<FaceOrigin>& origins);

}  // namespace scan2fea
