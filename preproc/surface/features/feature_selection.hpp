// Which of a scan's creases triangles of a given size can keep.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <span>
#include <vector>

namespace scan2fea {

struct FeatureSelection {
  // Areas that creases cut out of the surface must have room for so many equilateral triangles; smaller ones are joined
  // with the neighbour from which the smoothest crease parts them. A scan's folds and specks are full of them.
  double least_triangles = 4;
  // Creases that hang together and are shorter are dropped: those with ends inside the surface below this part of their
  // body's diagonal, since that is what the folds of organic scans have (the edges of a part hang together over
  // several diagonals), and those without, such as the rim of a hole, below so many edge lengths.
  double shortest_open_of_diagonal = 0.5;
  double shortest_closed = 3;
};

// The creases to keep, sorted; a subset of `sharp`. `edge_length`: mean one of the result or, per vertex of the scan,
// the wanted ones, model units. A few passes, each linear but for a sort.
std::vector<FeatureEdge> select_features(const SurfaceMesh& scan, std::vector<FeatureEdge> sharp, double edge_length,
                                         const FeatureSelection& selection = {});
std::vector<FeatureEdge> select_features(const SurfaceMesh& scan, std::vector<FeatureEdge> sharp,
                                         std::span<const double> edge_length, const FeatureSelection& selection = {});

// Without the creases that hang together over less than `longest` (model units) and come within `reach` of one of the
// places. Sorted as given.
std::vector<FeatureEdge> without_short_creases_near(const SurfaceMesh& scan, const std::vector<FeatureEdge>& sharp,
                                                    const std::vector<Vec3>& places, double reach, double longest);

// Without the edges of creases that come within `reach` of one of the places. Sorted as given.
std::vector<FeatureEdge> without_creases_near(const SurfaceMesh& scan, const std::vector<FeatureEdge>& sharp,
                                              const std::vector<Vec3>& places, double reach);

// A place on the surface, and how long the result's edges are there, model units.
struct SharpCorner {
  Vec3 place;
  double edge_length;
};

// Without the narrow part of the narrowest corner at each of the places: of the two creases that meet there, the
// smoother is given up from the corner on until they are more than 0.6 edges apart; triangles of that size could not
// lie between them. Sorted as given.
std::vector<FeatureEdge> without_narrow_corners(const SurfaceMesh& scan, const std::vector<FeatureEdge>& sharp,
                                                const std::vector<SharpCorner>& corners);

}  // namespace scan2fea
