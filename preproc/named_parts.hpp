// Parts of the surface that get a name: selected on the scan, carried to what is made of it.
#pragma once

#include "preproc/pipeline.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace scan2fea {

// What the options select of the surface that is to be simplified, or idealise. `given`: the scan before repair. Lines
// along the borders of sets go into `simplification`.
SelectedScan select_parts(const SurfaceMesh& whole, const SurfaceMesh& given, const PipelineOptions& options,
                          const Progress& progress, std::optional<SimplifyOptions>& simplification,
                          StageRecord& record);

// The sets on `result.surface`, whose triangles' order the boundary of the volume keeps; all faces, too, where
// `options.name_faces`. Those of `options.sets` must not vanish (NotMeshable); of the others, what is smaller than
// triangles may.
void carry_parts(const SelectedScan& selected, const PipelineOptions& options, const SimplifyResult& simplified,
                 PipelineResult& result);

// Which triangles of a surface that was made of the selected scan are to have layers. Precondition: the sets are
// there. Throws WrongUsage where two kinds of layers are to be behind one triangle, NotMeshable where a set is lost.
LayeredTriangles layered_triangles(const SelectedScan* selected, const std::vector<LayerOptions>& layers,
                                   const SurfaceMesh& surface, const std::vector<FeatureEdge>& lines);

// Throws WrongUsage where layers are asked for of a set that there is not.
void require_sets_of_layers(const SelectedScan* selected, const std::vector<LayerOptions>& layers);

// Puts a set of the result's triangles behind those that it has, with its figures. `area_of_scan`: where not given,
// that of the set.
void add_set(NamedSet set, std::optional<double> area_of_scan, PipelineResult& result);

// The vertices of the faces that are selected.
std::vector<bool> domain_of(const SurfaceMesh& scan, const NamedSelection& selection, const PipelineOptions& options,
                            const Progress& progress);

// The areas of the result's sets by the faces of its volume mesh.
void measure_sets(PipelineResult& result);

}  // namespace scan2fea
