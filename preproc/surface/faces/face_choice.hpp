// Which faces an expression selects, as far as it is of whole faces.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "preproc/surface/faces/find_faces.hpp"
#include "preproc/surface/faces/selection.hpp"

#include <span>
#include <string>
#include <vector>

namespace scan2fea {

// Per face. `selection` is a shape, a face's name, largest or nearest. Throws WrongUsage where it is none of the faces,
// with those that are nearly it.
std::vector<bool> chosen_faces(const SurfaceMesh& mesh, const SurfaceFaces& faces, const Selection& selection);

// "FACE_3 (cylinder, radius 5, axis (0, 0, 1), area 94.2)".
std::string describe(const SurfaceFace& face);

}  // namespace scan2fea
