// Sets of a surface's faces, as a mark per face that is not 0 for those in the set.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/rings.hpp"
#include "preproc/surface/repair/repair_result.hpp"
#include "quality/self_intersections.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace scan2fea {

// The faces of all pairs.
FaceMarks marks_of(std::span<const FacePair> pairs, std::size_t face_count);

// The vertices of the faces in the set, ascending.
std::vector<std::uint32_t> vertices_of(const SurfaceMesh& mesh, const FaceMarks& marks);

// The faces joined by common vertices, of all or only of those whose mark is `only`: a number per face (0 for the
// others) and the area of each number.
struct FacePieces {
  std::vector<std::uint32_t> of_face;
  std::vector<double> area;
};
FacePieces find_pieces(const SurfaceMesh& mesh, const FaceMarks& marks, std::optional<char> only);

// Removes the faces whose mark is not 0; the others keep their order. Counts, but logs no change.
void remove_faces(SurfaceMesh& mesh, const FaceMarks& marks, RepairResult& result);

// Logs a change for each face whose mark is not 0, its area as the size.
void log_faces(const SurfaceMesh& mesh, const FaceMarks& marks, RepairKind kind, RepairResult& result);

// Of one face.
double area_of(const SurfaceMesh& mesh, std::uint32_t face);
Vec3 centre_of(const SurfaceMesh& mesh, std::uint32_t face);

}  // namespace scan2fea
