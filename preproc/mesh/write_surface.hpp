// Writes STL (binary), OBJ, PLY (binary, little-endian, double) and OFF.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>

namespace scan2fea {

// Whether the extension, upper or lower case, is one of these formats.
bool is_surface_file(const std::filesystem::path& file);

// For messages.
std::string_view known_surface_formats();

// `measured`: that so many vertices, the first, were measured and the others made up; PLY says so of each by a property
// `measured`, 1 or 0. The format is told by the extension (WrongUsage where it is unknown). Numbers round-trip, but for
// STL, whose format holds 32-bit floats. Throws IoError; a file that stood there before is then untouched (see
// OutputFile).
void write_surface(const SurfaceMesh& mesh, const std::filesystem::path& file,
                   std::optional<std::size_t> measured = std::nullopt);

}  // namespace scan2fea
