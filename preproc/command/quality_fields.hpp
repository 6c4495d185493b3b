// How good each element of a mesh is, how far each node is from the scan, and where a face comes from, for viewers.
//
// Names are Verdict's, as VTK and PyVista write them, where Verdict has the measure: `edge_ratio`, `scaled_jacobian`,
// and of triangles `min_angle`, `max_angle`, degrees. Of tetrahedra they are
// `min_dihedral_deg` and `max_dihedral_deg`: VTK 9.1's minimum angle takes some angles for their supplements. Values
// are those of the figures, see element_measures.hpp: of second order of the curved element, and then also
// `jacobian_share`, the least Jacobian by its bound, as a share of the straight element's: below 0 it is inside out.
#pragma once

#include "export/mesh_file.hpp"

namespace scan2fea::command {

// The names of the fields that follow from a mesh and its sets, so that nothing is lost where a reader leaves them out.
bool is_quality_field(std::string_view name);

// Also `face`, the first of the sets of faces that the element has a face in, and `made_up` where such sets are (see
// made_up.hpp). Of nodes, if there is a reference, `deviation`: see signed_deviations_of_nodes. Adds to the options'
// fields. O(n), or O(n log n) with a reference; parallel.
void add_quality_fields(const TetMesh& mesh, const SurfaceMesh* reference, FileOptions& options);
void add_quality_fields(const NamedSurface& surface, const SurfaceMesh* reference, FileOptions& options);

}  // namespace scan2fea::command
