// Elmer's meshes: a folder of mesh.header, mesh.nodes, mesh.elements, mesh.boundary and mesh.names; the file that is
// named is the first. Bodies are sets of tetrahedra, boundaries sets of faces, each a number that mesh.names has a name
// for: 1 is EALL and SALL, of what is in no set; members of several sets have a number of their own. The unit is a
// comment in mesh.names.
//
// A mesh in N parts has beside these the folder partitioning.N, of which process K of `mpirun -n N ElmerSolver_mpi`
// reads part.K.header, .nodes, .elements, .boundary and .shared, as ElmerGrid writes them: numbers are those of the
// whole mesh, .shared has a line for each node that other parts have too, `NODE COUNT OWNER OTHERS...`, and no element
// is in two parts. A face between two bodies whose elements are in two parts is in both of them, each time with its own
// element alone. mesh.names holds for the parts, too.
#pragma once

#include "export/mesh_file.hpp"

#include <array>
#include <filesystem>

namespace scan2fea {

// `file` is FOLDER/mesh.header. Throws WrongUsage for another name, IoError; existing files are then untouched, unless
// they cannot be renamed. Coordinates round-trip. O(n).
Notes write_elmer(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});

// Of one part, from 1 on: header, nodes, elements, boundary, shared.
std::array<std::filesystem::path, 5> files_of_elmer_part(const std::filesystem::path& header, std::size_t parts,
                                                         std::size_t part);

// Throws InvalidInput naming file and line: unreadable, of other elements than tetrahedra and triangles, truncated.
MeshFile read_elmer(const std::filesystem::path& file);

}  // namespace scan2fea
