#include "preproc/command/element_fields.hpp"

#include "quality/jacobian_bound.hpp"
#include "quality/tetrahedron_measures.hpp"

namespace scan2fea::command {

std::vector<ElementField> element_fields(const TetMesh& mesh) {
  std::vector<ElementField> fields{{"scaled_jacobian", {}}, {"min_dihedral_deg", {}}};
  if (mesh.order() == 2) fields.push_back({"jacobian_share", {}});
  for (ElementField& field : fields) field.values.reserve(mesh.tetrahedra.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tetrahedra[t];
    const std::vector<Vec3>& x = mesh.nodes;
    const TetShape shape = measure_tetrahedron(mesh, t);
    fields[0].values.push_back(shape.scaled_jacobian);
    fields[1].values.push_back(shape.min_dihedral_deg);
    if (mesh.order() == 1) continue;
    const double straight = (x[b] - x[a]).cross(x[c] - x[a]).dot(x[d] - x[a]);
    const double least = min_jacobian_bound(curved_tetrahedron(mesh, t)).lower;
    fields[2].values.push_back(straight > 0 ? least / straight : 0);
  }
  return fields;
}

}  // namespace scan2fea::command
