// Curved triangles that lie on the scan.
//
// A straight surface of a given volume lies partly inside and partly outside of what it stands for, its corners farther
// out than the scan; nodes put onto the scan between such corners gain little. Here corners and nodes of the edges move
// together: each along its normal, by least squares of the scan's points against the curved triangles (point to plane,
// Gauss and Newton). The error then falls with the third to fourth power of the edge length instead of the second.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/curved/curved_deviation.hpp"
#include "preproc/surface/curved/curved_surface.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/features/planes_of_scan.hpp"
#include "preproc/surface/fit/reference_surface.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace scan2fea {

struct FittedCurves {
  CurvedSurface surface;
  // Along which a node may go to keep the volume; zero for nodes on lines of the scan and those that stay straight.
  std::vector<Vec3> directions;
  std::vector<double> volumes;  // of the components, see keep_curved_volume.hpp
  std::size_t straight = 0;     // triangles that stay as they were, since curved ones would meet others
};

// `surface` is a fitted surface of the scan with its net. Connectivity stays, and so does the volume of each component.
// Nodes on lines of the net lie on the scan's lines, and those in planes of the scan in these. `keep_corners`: only
// nodes of edges move. No two triangles meet that the straight ones kept apart, each taken as four plane ones, and no
// triangle of corners is below 30 degrees that was not so before. `kept`: a deviation, or null; triangles that are
// farther from the scan stay straight where they have it so. Throws Cancelled and OutOfTime. Deterministic for any
// number of threads. About 40 us a triangle.
FittedCurves fit_curves(const SurfaceMesh& surface, const FeatureNet& net, const ReferenceSurface& scan,
                        const PlanesOfScan& planes, bool keep_corners = false, const KeptDeviation* kept = nullptr,
                        const Progress& progress = {});

// The same of a piece of surface between borders, in place: nodes that are held stay where they are given, the others
// of its lines go to the scan's, and the rest is fitted. Returns the directions. Not guaranteed: that nothing meets.
std::vector<Vec3> fit_piece(CurvedSurface& surface, const std::vector<bool>& is_held, const FeatureNet& net,
                            const ReferenceSurface& scan, const Progress& progress = {});

// Gives a surface the volumes that it should have, by moving its nodes along their directions; false where it cannot.
using VolumeKeeper = std::function<bool(const std::vector<Vec3>& directions, CurvedSurface& surface)>;

// The fitted surface with its volumes. Faces that then meet others, whose corners went where they make a needle, or
// that lose a deviation that they keep as they were (null: none), are straight, and so is all of it, where that
// does not end, or too few nodes are left that may move to keep the volume. Returns how many are straight.
std::size_t settle(const CurvedSurface& straight, const VolumeKeeper& keep_volume, const KeptDeviation* kept,
                   CurvedSurface& fitted, std::vector<Vec3>& directions);

}  // namespace scan2fea
