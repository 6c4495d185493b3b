// The one function of ours that needs the Gmsh SDK, in a module that is loaded when it is called: libgmsh brings some
// ninety shared libraries with it, and to load those takes longer than many a command runs.
#pragma once

#include "export/msh.hpp"

#include <filesystem>
#include <string>

namespace scan2fea {

inline constexpr const char* gmsh_module_name = "scan2fea-gmsh.so";
inline constexpr const char* write_by_gmsh_name = "scan2fea_write_by_gmsh";

// Overwrites the file, whose name must end in ".msh": Gmsh tells the format by the extension, in lower case. `failure`
// is empty where that succeeded; nothing is thrown through the module's door.
using WriteByGmsh = void(const TetMesh& mesh, const std::filesystem::path& file, MshVersion version,
                         std::string& failure);

}  // namespace scan2fea
