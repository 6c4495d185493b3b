// The lattice chain up to the connectivity: lays a lattice of equilateral triangles on the scan and extracts it. The
// fitting of its vertices to the scan follows (shape_fit.hpp).
// Sources: Jakob et al. (2015) for fields over a hierarchy and extraction by them; Knöppel et al. (2013) for
// directions; the conformal coupling of directions and sizes, their relaxation and the intrinsic lattice coordinates
// are our own.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/features/feature_scan.hpp"
#include "preproc/surface/lattice/clean_connectivity.hpp"
#include "preproc/surface/lattice/orientation_field.hpp"
#include "preproc/surface/lattice/position_field.hpp"
#include "preproc/surface/lattice/scale_relaxation.hpp"
#include "preproc/surface/sizing/sizing_field.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace scan2fea {

struct LatticeOptions {
  SizingOptions sizing;  // and how many triangles
  // Scan edges longer than this times the wanted edge length are split, 0.2 to 0.7: longer ones leave holes, shorter
  // ones cost time.
  double longest_scan_edge = 0.7;
  OrientationOptions orientation;
  ScaleRelaxationOptions scale;
  PositionOptions position;
  ConnectivityOptions connectivity;  // its `triangles` is set from `sizing`
};

struct LatticeResult {
  std::string failure;  // why `mesh` is not what was asked for; empty where it is. Then the caller takes another way
  SurfaceMesh mesh;
  std::vector<double> edge_length;  // wanted, per vertex of `mesh`
  // The vertex of `mesh` near each vertex of the scan; with features, of the cut scan.
  std::vector<std::uint32_t> vertex_of_scan_vertex;
  FeatureNet net;            // empty without features
  double regular_share = 0;  // of the vertices, those of valence 6
  // Parts of the scan are thinner than the triangles, so that the lattice could not be read off as it is; expect
  // slivers and crossing triangles there.
  bool contracted = false;
};

// Precondition: manifold, oriented, free of self-intersections (see repair), closed but for borders that `features`
// has; any number of components, any genus. `mesh` is manifold and has the scan's components, genera and borders,
// always, and all of its features, with chains of edges along them. The number of triangles is the wanted one within
// 0.5 %, unless small components or features need more; where thin parts keep it from that, `failure` says so. Not
// guaranteed: freedom from self-intersections where the lattice is coarser than the shape. Throws WrongUsage for
// options out of range, InvalidInput for a scan without area, NotMeshable for one that is not closed or not manifold,
// Cancelled. Linear but for sorts; at most 250 bytes per triangle of the scan, where few edges need splitting.
// Deterministic for any number of threads.
LatticeResult remesh_by_lattice(const SurfaceMesh& scan, const LatticeOptions& options, const Progress& progress = {});

// The same with the edges of the part.
LatticeResult remesh_by_lattice(const FeatureScan& features, const LatticeOptions& options,
                                const Progress& progress = {});

}  // namespace scan2fea
