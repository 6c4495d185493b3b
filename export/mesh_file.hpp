// What a file of a mesh holds, and how it is to be written, for all formats alike.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <string>
#include <variant>
#include <vector>

namespace scan2fea {

// A volume mesh where the file has tetrahedra, else the surface of its triangles.
struct MeshFile {
  std::variant<NamedSurface, TetMesh> mesh;
  std::vector<std::string> warnings;  // what of the file is not in `mesh`, one line each

  bool is_volume() const { return std::holds_alternative<TetMesh>(mesh); }
};

enum class MshVersion { v2_2, v4_1 };

// Of one value for each element of a volume mesh, which viewers show.
struct ElementField {
  std::string name;
  std::vector<double> values;
};

struct FileOptions {
  std::string provenance;                     // where the mesh comes from, one line, for the headers that have room
  MshVersion msh_version = MshVersion::v4_1;  // Gmsh's own default; older readers (Elmer, Code_Aster, SU2) want 2.2
  std::vector<ElementField> fields;           // written by the formats of viewers
  bool ascii = false;                         // STL and PLY, which are binary otherwise
};

// What the user should know of a file that was written all the same; each entry is one line.
using Notes = std::vector<std::string>;

}  // namespace scan2fea
