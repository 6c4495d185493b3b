// Places of a finished mesh that a solver may refuse, so that nobody gets one without being told.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <string>
#include <vector>

namespace scan2fea {

// Degrees. CalculiX and Abaqus warn of angles around the first; below the second, an element's stiffness is lost in the
// rounding of the others'.
inline constexpr double small_angle_deg = 5, unusable_angle_deg = 0.5;

struct WeakPlace {
  std::string what;  // "smallest dihedral angle"
  double value;      // degrees, or a ratio
  double limit;
  Vec3 at;
  bool is_unusable = false;  // no solver takes it, and the scan does not ask for it

  // "smallest dihedral angle 3.2 at (1, 2, 3), below 5".
  std::string describe() const;
};

// Of the elements, or of the triangles where there is no `volume_mesh`: the smallest angle (dihedral, or of a triangle)
// where it is below 5 degrees, and the largest edge ratio where it is above 10. Below half a degree it is unusable,
// unless the scan itself is about as sharp within the element's size of there: at an edge between two of its faces, or
// in a corner between two of its sharp edges. Empty for a sound mesh. O(n).
// The first `flat_tetrahedra` are meant to be flat: they are weak only where they are unusable.
std::vector<WeakPlace> find_weak_places(const SurfaceMesh& surface, const TetMesh* volume_mesh, const SurfaceMesh& scan,
                                        std::size_t flat_tetrahedra = 0);

// Throws NotMeshable for the first that is unusable.
void refuse_unusable(const std::vector<WeakPlace>& places);

// Throws NotMeshable where the surface runs through itself: what lies within rounding in the frame in which it was made
// may cross in the scan's. About a microsecond a triangle.
void refuse_crossings(const SurfaceMesh& surface);

}  // namespace scan2fea
