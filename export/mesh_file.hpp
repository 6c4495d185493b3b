// What a file of a mesh holds, and how it is to be written, for all formats alike.
#pragma once

#include "preproc/mesh/named_sets.hpp"
#include "preproc/mesh/tet_mesh.hpp"

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace scan2fea {

class OutputFiles;

// Of nodes and elements in the order of a mesh.
struct FileNumbers {
  std::vector<std::uint64_t> nodes, elements;
  bool empty() const { return nodes.empty() && elements.empty(); }
};

// A volume mesh where the file has tetrahedra, else the surface of its triangles.
struct MeshFile {
  std::variant<NamedSurface, TetMesh> mesh;
  // That the file gives, where they are no row from 1 on, and all different; those of nodes only where they are its
  // own.
  FileNumbers numbers;
  bool has_own_numbers = false;                // whoever made the file chose them; else they follow from the format
  std::vector<std::string> warnings;           // what of the file is not in `mesh`, one line each
  std::vector<std::string> other_arrays = {};  // values of points and cells that a viewer's file has; they are not read

  bool is_volume() const { return std::holds_alternative<TetMesh>(mesh); }
};

enum class MshVersion { v2_2, v4_1 };

// One value for each element or each node, which viewers show; what has none is NaN.
struct Field {
  std::string name;
  std::vector<double> values;
  // Where there are any, values are whole numbers that stand for them, 1 for the first, and 0 for none of them.
  std::vector<std::string> names = {};
};

// Numbers of nodes and elements in files that have them, so that several meshes go into one deck: from the first on, in
// the order of the mesh, or those of their own. Of elements that are triangles, behind the tetrahedra.
struct Numbering {
  std::uint64_t first_node = 1, first_element = 1;
  FileNumbers own = {};
  std::uint64_t largest_of_own = 0;  // of the elements'

  std::uint64_t node(std::uint64_t index) const {
    return index < own.nodes.size() ? own.nodes[index] : first_node + index;
  }
  std::uint64_t element(std::uint64_t index) const {
    if (index < own.elements.size()) return own.elements[index];
    return own.elements.empty() ? first_element + index : largest_of_own + 1 + index - own.elements.size();
  }
  // Of all that have one of their own, and of more elements behind these.
  std::uint64_t largest_node(std::uint64_t count) const;
  std::uint64_t largest_element(std::uint64_t count) const;
  // Of what else has numbers, properties and groups: there are no more of them than elements, so that they meet none of
  // another mesh's.
  std::uint64_t other(std::uint64_t number) const { return first_element - 1 + number; }
  bool are_asked_for() const { return first_node != 1 || first_element != 1; }
};

struct FileOptions {
  std::string provenance = {};                // where the mesh comes from, one line, for the headers that have room
  MshVersion msh_version = MshVersion::v4_1;  // Gmsh's own default; older readers (Elmer, Code_Aster, SU2) want 2.2
  std::vector<Field> element_fields = {}, node_fields = {};  // written by the formats of viewers
  bool ascii = false;                                        // STL and PLY, which are binary otherwise
  std::string set_prefix = {};  // before the names of all sets, also of NALL, EALL and SALL
  Numbering numbers = {};
  // How many elements each part has, of a mesh that `order_by_parts` ordered; none: the mesh is not divided. For
  // formats that hold parts (see FileFormat).
  std::vector<std::uint32_t> part_sizes = {};
  OutputFiles* together = nullptr;  // with which the files are put in place; without them, at once
};

// What the user should know of a file that was written all the same; each entry is one line.
using Notes = std::vector<std::string>;

}  // namespace scan2fea
