// The formats of scans (STL, OBJ, PLY, OFF), see read_surface.hpp and write_surface.hpp, as the table of formats wants
// them.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

Notes write_plain_surface(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options);
// OBJ, sets of faces as groups.
Notes write_obj_groups(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options);

MeshFile read_plain_surface(const std::filesystem::path& file);

}  // namespace scan2fea
