// Sets of a surface's faces, as a mark per face that is not 0 for those in the set.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/self_intersections.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace scan2fea {

using FaceMarks = std::vector<char>;

// The faces of all pairs.
FaceMarks marks_of(std::span<const FacePair> pairs, std::size_t face_count);

// The vertices of the faces in the set, ascending.
std::vector<std::uint32_t> vertices_of(const SurfaceMesh& mesh, const FaceMarks& marks);

// Adds the faces that share a vertex with the set, again and again.
void grow(const SurfaceMesh& mesh, FaceMarks& marks, int rings);

// The faces joined by common vertices, of all or only of those whose mark is `only`: a number per face (0 for the
// others) and the area of each number.
struct FacePieces {
  std::vector<std::uint32_t> of_face;
  std::vector<double> area;
};
FacePieces find_pieces(const SurfaceMesh& mesh, const FaceMarks& marks, std::optional<char> only);

}  // namespace scan2fea
