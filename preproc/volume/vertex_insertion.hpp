// Putting a new vertex where elements are bad: the move that counts.
#pragma once

#include "preproc/volume/tet_complex.hpp"
#include "preproc/volume/vertex_star.hpp"

#include <vector>

namespace scan2fea {

// The elements that a new vertex would replace, and the vertex itself; kept between calls for its memory.
class VertexInsertion {
 public:
  // Tries the places that may mend element `bad`: inwards of its boundary faces by 0.45 and 0.7 of their mean edge, its
  // centroid, the middles of its interior edges. At each, the Delaunay cavity is grown or shrunk face by face while
  // that lifts the worst of the elements that join its faces to the vertex; vertices left without elements vanish; then
  // the vertex is moved to where the worst is best. The first that lifts the cavity's least quality by the factor
  // `gain`, and to `least`, is kept. Source: Klingner and Shewchuk, "Aggressive tetrahedral mesh improvement", 2007,
  // for the idea. Some 100 us where nothing is found.
  bool mend(TetComplex& complex, std::uint32_t bad, double gain, double least = 0);

 private:
  struct CavityFace {
    Triangle corners;  // (corners, vertex) is positive
    std::uint32_t inside, outside;
    double quality;
  };

  bool insert(TetComplex& complex, std::uint32_t bad, std::uint32_t holds_place, Vec3 place, double gain, double least);
  void take_delaunay_cavity(const TetComplex& complex, std::uint32_t holds_place, const Vec3& place);
  void find_faces(const TetComplex& complex, const Vec3& place);
  void improve_cavity(const TetComplex& complex, std::uint32_t bad, std::uint32_t holds_place, const Vec3& place);
  bool grow(const TetComplex& complex, const CavityFace& worst, const Vec3& place);
  bool shrink(const TetComplex& complex, const CavityFace& worst, const Vec3& place);

  std::vector<std::uint32_t> cavity_;
  std::vector<CavityFace> faces_, trial_;
  StarFaces star_;
  std::vector<TetComplex::Fresh> fresh_;
};

}  // namespace scan2fea
