// The triangles of a surface whose vertices were joined: counted with their signs, so that what lies twice on itself
// the opposite ways is none.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

// Of all triangles that have these corners, in rising order.
struct Facet {
  Triangle corners;
  std::int32_t turns;   // so many more turn that way than the other
  std::uint32_t first;  // the lowest number of one of them
};

// A chain of simplicial homology: the sum over triangles of a closed surface has no border, however its vertices are
// joined. 20 bytes for each set of three corners, twice that while more come.
class FacetChain {
 public:
  // A triangle with three different corners.
  void add(const Triangle& corners, std::uint32_t number);

  // After the last one: adds borders of tetrahedra all of whose faces are among the facets, wherever that leaves fewer
  // turns in all. Such tetrahedra are the folds that noise of the size of triangles makes: faces that the surface goes
  // through twice and edges with four triangles mostly go with them.
  void straighten();

  // In the order of their corners; those that cancel out stay, with no turns.
  std::vector<Facet> take() { return std::move(facets_); }

 private:
  void compact();

  std::vector<Facet> facets_;
  std::size_t when_compact_ = 0;
};

}  // namespace scan2fea
