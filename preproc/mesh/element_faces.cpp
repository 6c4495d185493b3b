#include "preproc/mesh/element_faces.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace scan2fea {
namespace {

struct Face {
  Triangle corners;  // ascending
  std::uint32_t apex;
  BoundaryFace face;
};

Face face_of(const std::vector<Tetrahedron>& tetrahedra, std::uint32_t t, std::uint8_t f) {
  Face face{.corners = {}, .apex = 0, .face = {t, f}};
  const auto& local = tetrahedron_faces[f];
  for (std::size_t k = 0; k < 3; ++k) face.corners[k] = tetrahedra[t][static_cast<std::size_t>(local[k])];
  face.apex = tetrahedra[t][static_cast<std::size_t>(6 - local[0] - local[1] - local[2])];
  std::ranges::sort(face.corners);
  return face;
}

// First by their least corners into buckets, which are small: a quarter of the time of sorting all at once.
std::vector<Face> sorted_faces(const std::vector<Tetrahedron>& tetrahedra) {
  std::uint32_t nodes = 0;
  for (const Tetrahedron& t : tetrahedra) nodes = std::max(nodes, *std::ranges::max_element(t) + 1);
  std::vector<std::size_t> end(std::size_t{nodes} + 1, 0);  // of each bucket, once it is full
  const auto for_each_face = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < tetrahedra.size(); ++t)
      for (std::uint8_t f = 0; f < 4; ++f) visit(face_of(tetrahedra, t, f));
  };
  for_each_face([&](const Face& face) { ++end[face.corners[0] + 1]; });
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<Face> faces(4 * tetrahedra.size());
  for_each_face([&](const Face& face) { faces[end[face.corners[0]]++] = face; });
  std::size_t begin = 0;
  for (std::uint32_t n = 0; n < nodes; begin = end[n++])
    std::sort(faces.begin() + static_cast<std::ptrdiff_t>(begin), faces.begin() + static_cast<std::ptrdiff_t>(end[n]),
              [](const Face& a, const Face& b) {
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

std::vector<std::array<std::uint32_t, 4>> element_neighbours(const std::vector<Tetrahedron>& tetrahedra) {
  std::vector<std::array<std::uint32_t, 4>> across(tetrahedra.size(), {no_element, no_element, no_element, no_element});
  const std::vector<Face> faces = sorted_faces(tetrahedra);
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i + 1;
    while (j < faces.size() && faces[j].corners == faces[i].corners) ++j;
    if (j == i + 2) {
      const BoundaryFace a = faces[i].face, b = faces[i + 1].face;
      across[a.tetrahedron][a.face] = b.tetrahedron;
      across[b.tetrahedron][b.face] = a.tetrahedron;
    }
    i = j;
  }
  return across;
}

}  // namespace scan2fea
