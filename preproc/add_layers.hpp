// Layers of elements behind parts of a filled surface.
#pragma once

#include "preproc/layers/join_layers.hpp"
#include "preproc/surface/features/planes_of_scan.hpp"
#include "preproc/tetrahedra_search.hpp"

#include <cstddef>

namespace scan2fea {

struct LayersResult {
  std::size_t triangles = 0;         // that have layers behind them
  std::size_t tetrahedra = 0;        // of the layers
  std::size_t all_tetrahedra = 0;    // of the mesh
  std::size_t nodes = 0;             // of the mesh
  std::size_t vertices = 0;          // of these triangles
  std::size_t lower_vertices = 0;    // of them, those behind which the layers are lower, since there is no room
  std::size_t tapered_vertices = 0;  // and those where they taper off
  double least_share = 1;            // of the height that was asked for, where there is least room
  Vec3 least_at = Vec3::Zero();
  double largest_move = 0;          // of a vertex beside layers, along the scan
  double deviation = 0;             // of the straight surface, where one was kept before; a bound
  double lost_deviation = 0;        // the same where it is more than was asked for
  double lost_volume_pct = 0;       // of the straight surface
  std::size_t parted_elements = 0;  // see two_sided_elements.hpp
  std::vector<ParallelEdge> parallel;
};

// `made` came of a simplification, `planes` of the same scan. Behind each layered triangle come wedges of three
// tetrahedra a layer; the last layer's ends are the surface of the rest, which is filled anew. Beside an edge of the
// body the layers go on to it: the vertices of the face beside make room, along the scan. Where there is no edge, the
// layers taper off. They are lower where a wall is too thin for them, where elements would turn over, where layers
// would meet, and beside what would lose a deviation that the surface has. The surface's volume is the scan's again,
// unless all beside the layers is plane, or it `is_to_be_curved`: then elements that could not be are parted. Throws
// NotMeshable where layers of different heights meet, and where there is no room for any. Deterministic.
LayersResult add_layers(const LayeredTriangles& layered, const PlanesOfScan& planes,
                        const TetrahedralizeOptions& options, bool is_to_be_curved, FilledSurface& made,
                        const Progress& progress);

}  // namespace scan2fea
