// From a filled surface of straight triangles to second-order tetrahedra with curved sides.
#pragma once

#include "preproc/layers/join_layers.hpp"
#include "preproc/mesh/progress.hpp"
#include "preproc/surface/curved/fit_curves.hpp"
#include "preproc/tetrahedra_search.hpp"
#include "preproc/volume/mid_edge_nodes.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

struct SecondOrderResult {
  CurveResult curved;
  std::size_t straight_triangles = 0;  // see FittedCurves
  std::size_t parted_elements = 0;     // see two_sided_elements.hpp
  std::vector<std::uint32_t> beyond;   // triangles that lost a deviation, since nodes of their edges were eased
  bool keeps_volume = true;            // else too few nodes were left to take up what easing took
  bool corners_kept = false;           // since between corners on the scan no tetrahedra came out in time
};

// Gives a filled mesh its mid-edge nodes, those of a fitted surface on its boundary. Nodes that are eased change the
// volume a little, which the other nodes of edges take up along their directions: by so little that no element suffers.
// `surface` and `directions` are then as they came out. Throws Cancelled.
void curve_as_fitted(CurvedSurface& surface, std::vector<Vec3>& directions, const VolumeKeeper& keep_volume,
                     TetMesh& mesh, SecondOrderResult& result, const Progress& progress = {});

// `made` came of `search`. Its triangles are fitted to the scan as curved ones, for which their corners move, too; then
// it is filled anew, and its tetrahedra get their mid-edge nodes. The enclosed volume is that of the straight surface.
// Throws Cancelled and OutOfTime, and then
// `made` is as it was.
SecondOrderResult make_second_order(const Simplification& search, const TetrahedralizeOptions& tetrahedralization,
                                    FilledSurface& made, const Progress& progress = {});

// With mid-edge nodes on the scan, where there is none beside the surface, where corner nodes are not its vertices, and
// where time is short.
SecondOrderResult curve_on_scan(const SurfaceMesh& scan, FilledSurface& made, const Progress& progress = {});

// The same as make_second_order where `made` has layers behind the corners of `fitted`: nodes of edges are as far from
// their middles as those of the surface's edges that they are parallel to; where vertices made room beside the layers,
// they are on the scan.
SecondOrderResult curve_layers(const FittedCurves& fitted, const std::vector<ParallelEdge>& parallel,
                               const SurfaceMesh& scan, FilledSurface& made, const Progress& progress = {});

}  // namespace scan2fea
