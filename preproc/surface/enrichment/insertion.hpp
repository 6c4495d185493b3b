// New points where the scanner left too few, put into the surface one after the other.
// Source: [1], section 2 (README.md lists the sources); enrich.hpp tells what differs from it.
#pragma once

#include "preproc/mesh/progress.hpp"
#include "preproc/surface/enrichment/enrich.hpp"
#include "preproc/surface/enrichment/surface_labels.hpp"
#include "preproc/surface/kernel/halfedge_mesh.hpp"

#include <vector>

namespace scan2fea {

struct Insertion {
  // Per vertex of the mesh from `first` on: where it was put, on the triangulation.
  HalfedgeMesh::Index first = 0;
  std::vector<Vec3> bases;
  EnrichResult result;
};

// The loop of section 2: each vertex of the domain that asks for a point gets one, until none does. `original`: the
// number of measured vertices, which come first; those between them and the mesh's end lie on creases. New points go
// onto their primitive at once. Those without one are lifted by `options.lifting`, or, where that is triharmonic, stay
// on the triangulation.
Insertion insert_points(HalfedgeMesh& mesh, SurfaceLabels& labels, HalfedgeMesh::Index original,
                        const EnrichOptions& options, const Progress& progress);

}  // namespace scan2fea
