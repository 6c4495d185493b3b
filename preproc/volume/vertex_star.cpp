#include "preproc/volume/vertex_star.hpp"

#include "preproc/volume/tet_complex.hpp"

#include <algorithm>

namespace scan2fea {

double look_from(const TetComplex& complex, std::uint32_t v, std::vector<std::uint32_t>& elements, StarFaces& faces) {
  complex.star(v, elements);
  faces.clear();
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t t : elements) {
    const TetComplex::Element& element = complex.element(t);
    const Triangle f = face_opposite(element.corners, corner_of(element.corners, v));
    faces.push_back({complex.node(f[0]), complex.node(f[2]), complex.node(f[1])});
    least = std::min(least, element.quality);
  }
  return least;
}

}  // namespace scan2fea
