// How good each element is, for viewers.
#pragma once

#include "export/mesh_file.hpp"

namespace scan2fea::command {

// `scaled_jacobian` and `min_dihedral_deg` (see TetShape), of second order those of the curved element; of second order
// also `jacobian_share`, the least Jacobian of the curved element by its bound, as a share of the straight one's: below
// 0 it is inside out. O(n).
std::vector<ElementField> element_fields(const TetMesh& mesh);

}  // namespace scan2fea::command
