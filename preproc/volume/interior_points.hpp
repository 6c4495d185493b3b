// Where the nodes inside a body go, before any tetrahedra: the point set decides the mean quality.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/volume/inside_test.hpp"

#include <optional>
#include <vector>

namespace scan2fea {

// Edge length of the tetrahedra deep inside.
struct InteriorSize {
  enum class Unit {
    of_surface,  // times the surface's edge length nearby, so that an adaptive surface has an adaptive interior
    model,       // model units
  };
  // Above 0. 1.3 of the surface gives the best mean quality, 1.6 few elements; above that edges grow inwards, by 0.3 of
  // an edge for each edge of depth, which costs quality and saves elements where walls are thick.
  double value = 1.6;
  Unit unit = Unit::of_surface;
};

// The mean length of the edges around each vertex, smoothed four times.
std::vector<double> surface_sizes(const SurfaceMesh& surface);

// A body-centred cubic lattice, on an octree where sizes differ: centres and corners of its cells, those that are
// inside and at least 0.3 local edge lengths from the surface, each displaced by 1e-4 of its cell so that predicates on
// the lattice's symmetric sets need no exact arithmetic. Cells halve where the wanted edge length asks for it; the
// lattice's edges are 0.911 of a cell in the mean. Same points whatever the number of threads. Some 2 us a point.
std::vector<Vec3> lattice_points(const SurfaceMesh& surface, const InsideTest& inside, const InteriorSize& size);

// The share of the surface's area behind which the wall is thinner than 0.8 of the local edge length: there a lattice
// has no room. Judged on some 2,000 triangles.
double thin_wall_share(const SurfaceMesh& surface, const InsideTest& inside);

}  // namespace scan2fea
