// Which element has a figure that is the least or the largest of all: where a gate on it fails.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <cstdint>
#include <optional>
#include <string_view>

namespace scan2fea {

struct ExtremeElement {
  std::uint32_t index;
  Vec3 place;  // the middle of its corners
};

// Of a figure of `volume_mesh` or of `surface` in a report; the first of equals. Nothing where the figure is not that
// of one element, as a mean or a volume. O(n).
std::optional<ExtremeElement> extreme_tetrahedron(const TetMesh& mesh, std::string_view figure);
std::optional<ExtremeElement> extreme_triangle(const SurfaceMesh& mesh, std::string_view figure);

}  // namespace scan2fea
