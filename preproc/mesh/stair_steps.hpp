// Surfaces of images: the faces of voxels, or walls around slices, which have stairs where the part has slopes.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <array>
#include <optional>

namespace scan2fea {

struct StairSteps {
  enum class Kind {
    voxels,  // all faces are halves of the faces of boxes of one size, which may lie askew
    slices,  // all faces lie along planes at equal distances, or across from one to the next
  };
  Kind kind;
  std::array<double, 3> size = {};  // of a voxel, ascending; of a slice its height, thrice
  double largest() const { return size[2]; }
};

// Nothing where there are few stairs, as on boxes with faces of one size, or the steps are fewer than ten, as of a
// shaft with shoulders. Corners that equal one another must be one vertex; a tenth of the faces may be otherwise, as
// repair leaves them where voxels touch at an edge. O(n).
std::optional<StairSteps> find_stair_steps(const SurfaceMesh& mesh);

}  // namespace scan2fea
