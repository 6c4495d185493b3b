// Gmsh mesh files (.msh), versions 2.2 and 4.1. Read and written by ourselves: the SDK runs what a file or its
// neighbours say as a script, does not survive every damaged file, rounds coordinates to 16 digits, and does not notice
// that a disk is full.
//
// Sets are physical groups, of tetrahedra, of boundary triangles (facing outwards), and of point elements for sets of
// nodes. Most readers of these files (meshio, DOLFINx, ElmerGrid) take an element once for each group that it is in, so
// that the groups EALL and SALL hold the tetrahedra and the boundary triangles of no other set: all of them where no
// set is named. The unit is a comment.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>

namespace scan2fea {

// ASCII, since not every reader takes binary files; coordinates round-trip. Node and element numbers are the indices of
// `mesh` plus one; in elements, triangles come after tetrahedra, and points after triangles. In version 2.2 an element
// has one group: a triangle of several sets is written several times, a tetrahedron goes to its first set, which is
// noted. Precondition: mesh.boundary lists the boundary faces. Throws IoError; an existing file is then untouched.
Notes write_msh(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});
Notes write_msh(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options = {});

// Reads the tetrahedra, or else the triangles, of an MSH file of version 2.x or 4.1, ASCII or binary of both byte
// orders, with its physical groups; a group without a name is called PHYSICAL_7. The nodes that elements use are kept,
// in the order of their numbers. Throws InvalidInput naming file and line (byte, if binary): unreadable, not MSH,
// another version, truncated, no elements, solid elements of another shape, orders mixed, a node missing or defined
// twice.
MeshFile read_msh(const std::filesystem::path& file);

}  // namespace scan2fea
