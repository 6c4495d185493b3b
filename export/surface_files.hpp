// The formats of scans (STL, OBJ, PLY, OFF), see read_surface.hpp and write_surface.hpp, as the table of formats wants
// them.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

Notes write_plain_surface(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options);
// The unit of a comment that `write_surface` wrote; empty where there is none.
std::string unit_in_head(const std::filesystem::path& file);

MeshFile read_plain_surface(const std::filesystem::path& file);

}  // namespace scan2fea
