#include "preproc/surface/repair/face_marks.hpp"

#include "preproc/surface/kernel/adjacency.hpp"
#include "preproc/surface/kernel/components.hpp"

#include <algorithm>

namespace scan2fea {

double area_of(const SurfaceMesh& mesh, std::uint32_t face) {
  return area_vector(mesh, mesh.triangles[face]).norm() / 2;
}

Vec3 centre_of(const SurfaceMesh& mesh, std::uint32_t face) {
  return centroid(mesh, mesh.triangles[face]);
}

FaceMarks marks_of(std::span<const FacePair> pairs, std::size_t face_count) {
  FaceMarks marks(face_count, 0);
  for (const FacePair& pair : pairs) marks[pair.face] = marks[pair.other] = 1;
  return marks;
}

std::vector<std::uint32_t> vertices_of(const SurfaceMesh& mesh, const FaceMarks& marks) {
  std::vector<std::uint32_t> vertices;
  for (std::size_t f = 0; f < marks.size(); ++f)
    if (marks[f]) vertices.insert(vertices.end(), mesh.triangles[f].begin(), mesh.triangles[f].end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

FacePieces find_pieces(const SurfaceMesh& mesh, const FaceMarks& marks, std::optional<char> only) {
  const auto counts = [&](std::size_t f) { return !only || marks[f] == *only; };
  SurfaceMesh part{mesh.vertices, {}};
  for (std::size_t f = 0; f < marks.size(); ++f)
    if (counts(f)) part.triangles.push_back(mesh.triangles[f]);
  const Components components = find_components(part);
  FacePieces pieces;
  pieces.of_face.assign(marks.size(), 0);
  std::vector<std::uint32_t> number(components.count, no_face);
  for (std::uint32_t f = 0; f < marks.size(); ++f) {
    if (!counts(f)) continue;
    std::uint32_t& n = number[components.of_vertex[mesh.triangles[f][0]]];
    if (n == no_face) {
      n = static_cast<std::uint32_t>(pieces.area.size());
      pieces.area.push_back(0);
    }
    pieces.of_face[f] = n;
    pieces.area[n] += area_of(mesh, f);
  }
  return pieces;
}

void remove_faces(SurfaceMesh& mesh, const FaceMarks& marks, RepairResult& result) {
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    if (!marks[f]) mesh.triangles[kept++] = mesh.triangles[f];
  result.faces_removed += mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
}

void log_faces(const SurfaceMesh& mesh, const FaceMarks& marks, RepairKind kind, RepairResult& result) {
  for (std::uint32_t f = 0; f < marks.size(); ++f)
    if (marks[f]) result.changes.push_back({kind, centre_of(mesh, f), area_of(mesh, f), area_of(mesh, f)});
}

}  // namespace scan2fea
