// Which of a scan's creases triangles of a given size can keep.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/feature_edge.hpp"

#include <vector>

namespace scan2fea {

struct FeatureSelection {
  // Areas that creases cut out of the surface must have room for so many equilateral triangles; smaller ones are joined
  // with the neighbour from which the smoothest crease parts them. A scan's folds and specks are full of them.
  double least_triangles = 4;
  // Chains of creases that hang together and are shorter than this times the edge length are dropped.
  double shortest_chain = 4;
};

// The creases to keep, sorted; a subset of `sharp`. `edge_length`: mean one of the result, model units. A few passes,
// each linear but for a sort.
std::vector<FeatureEdge> select_features(const SurfaceMesh& scan, std::vector<FeatureEdge> sharp, double edge_length,
                                         const FeatureSelection& selection = {});

}  // namespace scan2fea
