// Places where two borders of a triangle soup all but meet, and how far apart they are.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// A vertex on a border beside an edge on a border that it is no end of.
struct BorderGap {
  std::uint32_t vertex;
  std::uint32_t halfedge;  // 3 f + i, the only one of its edge
  double along = 0;        // of the edge's point nearest to the vertex: 0 at its start, 1 at its end
  double distance = 0;     // from that point to the vertex
};

// All gaps up to a thousandth of the mesh's bounding-box diagonal, or a step of coarse coordinates
// (coordinate_step.hpp), and an eighth of the shorter of the border edges that meet there, beyond which what lies apart
// may well be meant to; in ascending order of distance. Left out are those across a wall: between two faces that lie
// upon one another, nowhere farther apart than three times the gap. Joining them would close the opening of a
// thin-walled shell instead of a seam.
//
// Costs O(b log^3 b) for b border edges (Zomorodian and Edelsbrunner's streamed segment trees, from CGAL).
std::vector<BorderGap> find_border_gaps(const SurfaceMesh& mesh);

}  // namespace scan2fea
