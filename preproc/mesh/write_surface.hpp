// Writes STL and PLY, both binary or text, OBJ and OFF.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace scan2fea {

class OutputFiles;

// Whether the extension, upper or lower case, is one of these formats.
bool is_surface_file(const std::filesystem::path& file);

// For messages.
std::string_view known_surface_formats();

struct SurfaceFileOptions {
  std::optional<std::size_t> measured;  // so many vertices, the first, were measured and the others made up: PLY says
                                        // so of each by a property `measured`, 1 or 0
  std::string unit;                     // of length, for a comment; empty: none
  std::vector<NamedSet> face_sets;      // groups of OBJ; names without blanks
  bool ascii = false;                   // STL and PLY as text; Gmsh 4.8 does not read doubles of a binary PLY
  OutputFiles* together = nullptr;      // with which the file is put in place; without them, at once
};

// The format is told by the extension (WrongUsage where it is unknown). Numbers round-trip, but for STL, whose format
// holds 32-bit floats; binary PLY is little-endian, with doubles. Throws IoError; a file that stood there before is
// then untouched (see OutputFile).
void write_surface(const SurfaceMesh& mesh, const std::filesystem::path& file, const SurfaceFileOptions& options = {});

}  // namespace scan2fea
