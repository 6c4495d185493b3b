// The formats of volume meshes, told by the file's extension.
#pragma once

#include "export/msh.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

enum class VolumeFormat { inp, msh, vtu };

// By the extension, upper or lower case; nothing where it is not one of a volume mesh.
std::optional<VolumeFormat> volume_format(const std::filesystem::path& file);

// For messages: ".inp (Abaqus, CalculiX), .msh (Gmsh), .vtu (VTK)".
std::string_view known_volume_formats();

struct VolumeFileOptions {
  std::string unit;                           // of length, for the headers of formats that have room for it
  std::string provenance;                     // where the mesh comes from, one line, likewise
  MshVersion msh_version = MshVersion::v4_1;  // see MshOptions
};

// What the user should know of a file that was written all the same; each entry is one line.
struct VolumeFileWritten {
  std::vector<std::string> warnings;
};

// Throws WrongUsage for an unknown extension, IoError where the file cannot be written.
VolumeFileWritten write_volume(const TetMesh& mesh, const std::filesystem::path& file,
                               const VolumeFileOptions& options = {});

// Throws WrongUsage for an unknown extension, InvalidInput for what the readers of the formats say. The boundary of the
// mesh is found anew, ordered by tetrahedron and face, and nodes keep the file's order; so "boundary nodes come first"
// holds only for files that were written so. Elements are taken as they are, inverted ones included.
TetMesh read_volume(const std::filesystem::path& file);

}  // namespace scan2fea
