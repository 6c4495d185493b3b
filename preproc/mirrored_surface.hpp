// The whole of a symmetric part from the mesh of its half.
#pragma once

#include "preproc/symmetry/half_scan.hpp"
#include "preproc/tetrahedra_search.hpp"

#include <cstddef>
#include <vector>

namespace scan2fea {

// Per vertex of the surface that was made of the half, in its coordinates, whether it belongs to the cut. `lines`: its
// edges that stand for lines, sorted.
std::vector<bool> vertices_of_cut(const SurfaceMesh& surface, const HalfScan& half,
                                  const std::vector<FeatureEdge>& lines);

struct MirroredSurface {
  FilledSurface made;              // of the whole scan, in its coordinates
  std::size_t nodes_on_plane = 0;  // which both sides share; of the surface alone its vertices
};

// `half` in the frame, its cut at x = 0: what lies there, within rounding, is put there exactly and shared by both
// sides; all else is there twice, the copy's coordinates those of the original but for the sign of x. Nodes keep the
// order that TetMesh promises. Lines along the cut stay where the surface has an edge there. Throws MeshingFailed where
// the mesh's cut is not the scan's.
MirroredSurface mirrored(FilledSurface half, const MirrorFrame& frame);

}  // namespace scan2fea
