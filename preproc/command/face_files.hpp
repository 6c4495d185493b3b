// Faces as figures and as files for viewers.
#pragma once

#include "export/mesh_file.hpp"
#include "preproc/command/output_files.hpp"
#include "preproc/surface/faces/find_faces.hpp"
#include "quality/report.hpp"

#include <filesystem>
#include <string>

namespace scan2fea::command {

// One object a face: name, kind, area, triangles, place, and what its kind has: normal and offset, axis, origin,
// radius, hollow, tube_radius, half_angle_deg, mean_misfit, largest_misfit.
Json face_list(const SurfaceFaces& faces);

// The same for a terminal, a line a face.
std::string face_table(const SurfaceFaces& faces);

bool is_face_file(const std::filesystem::path& file);

// The surface, whose sets are the faces, with the number of each triangle's face (FACE_3: 3): as .ply (a property
// `face`, and a colour), .vtp or .vtu (cell data `face`); by the extension.
Notes write_face_file(const NamedSurface& surface, const SurfaceFaces& faces, const std::filesystem::path& file,
                      OutputFiles& outputs);

}  // namespace scan2fea::command
