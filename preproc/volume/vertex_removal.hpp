// Replacing the elements around an interior vertex by better ones without it.
#pragma once

#include "preproc/volume/tet_complex.hpp"

#include <vector>

namespace scan2fea {

class VertexRemoval {
 public:
  // Contracts an edge from an interior corner of element `bad` to one of that corner's neighbours, the first for which
  // the smallest quality of the star rises by the factor `gain`: what mends thin wedges and walls in which the lattice
  // has set a vertex for which there is no room. Returns whether there was one. Some 24 elements times 14 neighbours,
  // most of them given up at the first element that is turned over.
  bool mend(TetComplex& complex, std::uint32_t bad, double gain);

 private:
  bool remove(TetComplex& complex, std::uint32_t vertex, double gain);
  bool contract(TetComplex& complex, std::uint32_t vertex, std::uint32_t into, double floor);

  std::vector<std::uint32_t> star_, neighbours_;
  std::vector<TetComplex::Fresh> fresh_;
};

}  // namespace scan2fea
