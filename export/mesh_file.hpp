// What a file of a mesh holds, and how it is to be written, for all formats alike.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace scan2fea {

// A volume mesh where the file has tetrahedra, else the surface of its triangles.
struct MeshFile {
  std::variant<NamedSurface, TetMesh> mesh;
  std::vector<std::string> warnings;  // what of the file is not in `mesh`, one line each
  // Per tetrahedron, or triangle, its number in the file, where these are no row from 1 on.
  std::vector<std::uint32_t> element_numbers = {};

  bool is_volume() const { return std::holds_alternative<TetMesh>(mesh); }
};

enum class MshVersion { v2_2, v4_1 };

// Of one value for each element of a volume mesh, which viewers show.
struct ElementField {
  std::string name;
  std::vector<double> values;
};

// Numbers of nodes and elements in files that have them, so that several meshes go into one deck: from the first on, in
// the order of the mesh. Of elements that are triangles, behind the tetrahedra.
struct Numbering {
  std::uint64_t first_node = 1, first_element = 1;

  std::uint64_t node(std::uint64_t index) const { return first_node + index; }
  std::uint64_t element(std::uint64_t index) const { return first_element + index; }
  // Of what else has numbers, properties and groups: there are no more of them than elements, so that they meet none of
  // another mesh's.
  std::uint64_t other(std::uint64_t number) const { return first_element - 1 + number; }
  bool operator==(const Numbering&) const = default;
};

struct FileOptions {
  std::string provenance = {};                // where the mesh comes from, one line, for the headers that have room
  MshVersion msh_version = MshVersion::v4_1;  // Gmsh's own default; older readers (Elmer, Code_Aster, SU2) want 2.2
  std::vector<ElementField> fields = {};      // written by the formats of viewers
  bool ascii = false;                         // STL and PLY, which are binary otherwise
  std::string set_prefix = {};                // before the names of all sets, also of NALL, EALL and SALL
  Numbering numbers = {};
};

// What the user should know of a file that was written all the same; each entry is one line.
using Notes = std::vector<std::string>;

}  // namespace scan2fea
