// New points where the scanner left too few, put into the surface one after the other.
// Source: [1], section 2 (README.md lists the sources); enrich.hpp tells what differs from it.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/enrichment/clear_surface.hpp"
#include "preproc/surface/enrichment/enrich.hpp"
#include "preproc/surface/enrichment/surface_labels.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <vector>

namespace scan2fea {

struct Insertion {
  // Per vertex of the mesh from `first` on: where it was put, on the triangulation.
  HalfedgeMesh::Index first = 0;
  std::vector<Vec3> bases;
  std::vector<bool> in_gap;     // whether it stays there, since it lies between primitives and on none
  std::vector<bool> on_crease;  // per vertex of the mesh: whether it lies on a sharp edge, restored or the scan's own
  EnrichResult result;
};

// The loop of section 2: each vertex of the domain that asks for a point gets one, until none does. `original`: the
// number of measured vertices, which come first; those between them and the mesh's end lie on creases. New points go
// onto their primitive at once. Those without one are lifted by `options.lifting`; where that is triharmonic, by
// Hermite least squares, from where it starts: from flat faces thin limbs of a scan come out a fifth worse.
Insertion insert_points(HalfedgeMesh& mesh, SurfaceLabels& labels, ClearSurface& clear, HalfedgeMesh::Index original,
                        const EnrichOptions& options, const Progress& progress);

}  // namespace scan2fea
