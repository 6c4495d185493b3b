#include "preproc/mesh/element_faces.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

struct Face {
  Triangle corners;  // ascending
  std::uint32_t apex;
  BoundaryFace face;
};

std::vector<Face> sorted_faces(const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<Face> faces;
  faces.reserve(tetrahedra.size() * 4);
  for (std::uint32_t t = 0; t < tetrahedra.size(); ++t)
    for (std::uint8_t f = 0; f < 4; ++f) {
      Face face{.corners = {}, .apex = 0, .face = {t, f}};
      const auto& local = tetrahedron_faces[f];
      for (std::size_t k = 0; k < 3; ++k) face.corners[k] = tetrahedra[t][static_cast<std::size_t>(local[k])];
      face.apex = tetrahedra[t][static_cast<std::size_t>(6 - local[0] - local[1] - local[2])];
      std::ranges::sort(face.corners);
      faces.push_back(face);
    }
  std::ranges::sort(faces, [](const Face& a, const Face& b) {
    return a.corners != b.corners ? a.corners < b.corners : a.face.tetrahedron < b.face.tetrahedron;
  });
  return faces;
}

}  // namespace

ElementFaces find_element_faces(const std::vector<Tetrahedron>& tetrahedra) {
  const std::vector<Face> faces = sorted_faces(tetrahedra);
  ElementFaces found;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i + 1;
    while (j < faces.size() && faces[j].corners == faces[i].corners) ++j;
    if (j == i + 1) found.boundary.push_back(faces[i].face);
    if ((j > i + 2 || (j == i + 2 && faces[i].apex == faces[i + 1].apex)) && !found.overlapping)
      found.overlapping = {faces[i].face.tetrahedron, faces[j - 1].face.tetrahedron};
    i = j;
  }
  std::ranges::sort(found.boundary, [](BoundaryFace a, BoundaryFace b) {
    return a.tetrahedron != b.tetrahedron ? a.tetrahedron < b.tetrahedron : a.face < b.face;
  });
  return found;
}

}  // namespace scan2fea
