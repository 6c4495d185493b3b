// Which networks of sharp edges are creases of a part, and which are folds, roundings and noise.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scan2fea {

// What is wrong with sharp edges that are not kept: the largest of the first three figures, means over the length of a
// network.
// Creases of parts, with planes, cylinders or other smooth faces beside them, have 0 to 0.06, 0 to 0.13 and 0 to 0.02,
// folds of organic scans 0.1 to 0.5, 0.15 to 0.5 and 0.02 to 0.3.
enum class CreaseFault {
  rounded,  // how far the surface turns across the crease at the next edges beside it, over the crease's own angle
  uneven,   // how the angle changes from edge to edge, over itself
  zigzag,   // turns of the line that cancel from vertex to vertex, radians
  folded,   // a triangle or two, folded over their neighbours
};
std::string describe(CreaseFault fault);  // of sharp edges, as the end of a sentence

// All networks with one fault.
struct UnsupportedCreases {
  CreaseFault fault;
  std::size_t networks = 0;
  std::size_t edges = 0;
  Vec3 place = Vec3::Zero();  // on the one with the most edges
};

struct JudgedCreases {
  std::vector<FeatureEdge> kept;  // sorted
  std::vector<UnsupportedCreases> dropped;
};

struct CreaseSurface {
  const SurfaceMesh& scan;
  const std::vector<Triangle>& neighbours;  // see face_neighbours
  const std::vector<Vec3>& normals;         // of faces, as they are
  double noise;                             // standard deviation of the vertices, model units
};

// Networks are the sharp edges that hang together; each is kept or dropped as a whole. What noise accounts for is taken
// off the figures; since the noise of a coarse scan cannot be told from its shape, the angle of a network that needs
// this must be steady over several edges, too. `sharp`: interior edges, sorted. Linear in the scan but for a sort of
// the edges.
JudgedCreases judge_creases(const CreaseSurface& surface, std::span<const FeatureEdge> sharp);

}  // namespace scan2fea
