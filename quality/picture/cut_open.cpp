#include "quality/picture/cut_open.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

struct Face {
  Triangle sorted;
  std::uint32_t tetrahedron;
  std::uint8_t face;
};

bool stays(const TetMesh& mesh, std::uint32_t t, const Cut& cut) {
  Vec3 middle = Vec3::Zero();
  for (const std::uint32_t n : mesh.tetrahedra[t]) middle += mesh.nodes[n] / 4;
  return cut.keeps(middle);
}

Triangle sorted_corners(const TetMesh& mesh, BoundaryFace f) {
  Triangle corners = boundary_triangle(mesh, f);
  std::ranges::sort(corners);
  return corners;
}

}  // namespace

SeenFaces seen_faces(const TetMesh& mesh, const Cut& cut) {
  std::vector<Face> faces;
  std::vector<std::array<std::uint32_t, 4>> boundary_of(mesh.tetrahedra.size());
  for (auto& of : boundary_of) of.fill(SeenFaces::inside);
  for (std::uint32_t f = 0; f < mesh.outer_faces(); ++f)
    boundary_of[mesh.boundary[f].tetrahedron][mesh.boundary[f].face] = f;
  for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
    if (stays(mesh, t, cut))
      for (std::uint8_t k = 0; k < 4; ++k) faces.push_back({sorted_corners(mesh, {t, k}), t, k});
  std::ranges::sort(faces, [](const Face& a, const Face& b) {
    return std::tie(a.sorted, a.tetrahedron) < std::tie(b.sorted, b.tetrahedron);
  });
  SeenFaces seen;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto is_same = [&](std::size_t j) { return j < faces.size() && faces[j].sorted == faces[i].sorted; };
    if (is_same(i + 1) || (i > 0 && is_same(i - 1))) continue;
    const Face& face = faces[i];
    seen.faces.push_back({face.tetrahedron, face.face});
    seen.boundary_face.push_back(boundary_of[face.tetrahedron][face.face]);
  }
  return seen;
}

}  // namespace scan2fea
