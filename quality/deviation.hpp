// How far a surface lies from a reference, and how much their volumes and areas differ.
//
// Distances are sampled from both sides, as Metro does (Cignoni, Rocchini, Scopigno, 1998): from all vertices of each
// surface, and from random points of it, to the nearest point of the other. The points are stratified by area, one in
// each of N equal parts, which has less variance than independent ones. The sampled Hausdorff distance is a lower bound
// of the true one; distances to the other surface ignore its orientation and topology.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace scan2fea {

struct DeviationOptions {
  // Random points on each surface, beside its vertices; 200,000 settle the RMS of a scan to about 0.3 %.
  std::size_t samples = 200'000;
  std::uint64_t seed = 1;  // of the random points
  // What the reference encloses, where its own faces do not tell: a scan that is open, or crosses itself.
  std::optional<double> reference_volume = std::nullopt;
  // Of a mesh of several bodies: the reference is all of their surfaces, so that faces between two bodies count, once
  // for either; else the outside alone is compared.
  bool reference_is_of_bodies = false;
};

// From the vertices and samples of one surface to the other, in per cent of the diagonal of the reference's box.
struct OneSidedDistance {
  double hausdorff_pct_diagonal = 0;
  double rms_pct_diagonal = 0;
};

struct Deviation {
  // Of the enclosed volumes' sizes, (mesh - reference) / reference in per cent; nothing if one of the two encloses
  // none, or as little as a sheet with two sides.
  std::optional<double> volume_difference_pct;
  double area_difference_pct = 0;
  double hausdorff_pct_diagonal = 0;   // the larger of the two sides; per cent of the reference's bounding-box diagonal
  double rms_pct_diagonal = 0;         // the larger of the two sides
  OneSidedDistance from_mesh;          // to the reference: what was invented
  OneSidedDistance from_reference;     // to the mesh: what was lost
  double hausdorff = 0;                // model units
  Vec3 farthest_point = Vec3::Zero();  // the sample that is farthest from the other surface
  Vec3 nearest_to_farthest = Vec3::Zero();  // the other surface's point nearest to that one
  bool farthest_is_on_reference = false;    // which surface the farthest sample is a point of
};

// Throws InvalidInput if one of the surfaces has no triangle or no area. About 0.5 us a sample and thread; the result
// does not depend on the number of threads. Vertices that no triangle uses, as the
// invalid points of scanners, do not count.
Deviation measure_deviation(const SurfaceMesh& mesh, const SurfaceMesh& reference,
                            const DeviationOptions& options = {});

// Of the boundary of a mesh of tetrahedra, which of second order is curved: its nodes and random points of its curves
// are measured, and points of the reference to flat pieces that are no farther from them than 2e-5 of the diagonal.
Deviation measure_deviation(const TetMesh& mesh, const SurfaceMesh& reference, const DeviationOptions& options = {});

}  // namespace scan2fea
