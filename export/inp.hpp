// Abaqus and CalculiX input decks (.inp): the mesh and its sets, to be included by the deck that holds the analysis.
//
// Written: *NODE, *ELEMENT of C3D4 or C3D10, and these sets (upper case, as CalculiX stores them):
//   NALL                  all nodes
//   EALL                  all elements
//   SALL                  *SURFACE of element faces, the whole boundary
//   SALL_S1 .. SALL_S4    the elements whose face S1 .. S4 lies on the boundary; SALL is made of these
//   SALL_NODES            the nodes of the boundary, mid-edge nodes included, for supports and prescribed displacements
// Only comments precede *NODE, so `*INCLUDE, INPUT=part.inp` works at any place of a deck.
//
// CalculiX 2.20 reads at most 20 characters of a number, 10 of an integer and 132 of a line; all lines keep to that.
#pragma once

#include "export/mesh_file.hpp"
#include "export/set_names.hpp"

#include <filesystem>

namespace scan2fea {

// Besides those above, per set: *NSET; *ELSET; and of faces a *SURFACE made of element sets NAME_S1 .. NAME_S4, with
// its nodes as NAME_NODES. Node and element numbers are the indices of `mesh` plus one. Coordinates are written with
// the fewest digits that round-trip or, where these take more than 20 characters, with the most that fit (see
// write_number). The unit is a comment, since a deck has no field for it. Notes elements that CalculiX will refuse,
// and names that had to be changed.
// Precondition: mesh.boundary lists the boundary faces. Throws IoError; an existing file is then untouched. O(n).
Notes write_inp(const TetMesh& mesh, const std::filesystem::path& file, const FileOptions& options = {});

// What write_inp calls the sets of a mesh; notes those that had to be changed.
WrittenNames names_in_inp(const TetMesh& mesh, const std::string& prefix, Notes& notes);

// As elements S3, sets of faces as *ELSET.
Notes write_inp(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options = {});

// Reads the tetrahedra of a deck, or where it has none its triangles: *NODE and *ELEMENT of C3D4.. and C3D10.. types
// (and their DC3D.. heat variants), of shells and membranes of three and six nodes, any numbering, several blocks,
// continuation lines; *NSET, *ELSET (also GENERATE, and sets of sets) and *SURFACE. All other keywords are passed over.
// The nodes that elements use are kept, in the order of their numbers; the elements in the order of the file.
// Throws InvalidInput naming file and line: unreadable, no elements, solid elements of another shape, orders mixed,
// a number that does not parse, a node that is missing or defined twice. *INCLUDE is not followed.
MeshFile read_inp(const std::filesystem::path& file);

}  // namespace scan2fea
