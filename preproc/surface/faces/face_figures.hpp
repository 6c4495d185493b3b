// What each face is, how well, and in which order faces are named.
#pragma once

#include "preproc/surface/faces/find_faces.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace scan2fea {

// The shape that describes a surface's vertices within `sigma` (model units, > 0) and has the shortest description;
// nothing where none does. Which of the triangles' sides is outside their order tells.
std::optional<Shape> fit_face(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& triangles, double sigma);

// Of a triangle on the face's shape, without noise, which makes a surface larger than what it is of, and curved, since
// facets make it smaller. Of a free-form face, as it is.
double area_on_shape(const SurfaceMesh& mesh, std::uint32_t triangle, const SurfaceFace& face);

// Area, place and misfit of a face whose triangles and shape are known.
void measure_face(const SurfaceMesh& mesh, const std::vector<bool>& is_border_vertex, SurfaceFace& face);

// Sorts and names them; see find_faces.hpp.
void name_faces(const SurfaceMesh& mesh, double noise, std::vector<SurfaceFace>& faces);

}  // namespace scan2fea
