// The sets of a file, by its numbers, on the way to those of a mesh.
#pragma once

#include "export/raw_mesh.hpp"

#include <functional>
#include <optional>

namespace scan2fea {

// What a node number is in the mesh; nothing where no element uses it.
using FindNode = std::function<std::optional<std::uint32_t>(std::uint64_t)>;

// To the mesh that `assemble` made of `raw`, its elements in raw's order. What the mesh has no place for is told.
void add_sets(const RawMesh& raw, const FindNode& find_node, TetMesh& mesh, std::vector<std::string>& warnings);
void add_sets(const RawMesh& raw, const FindNode& find_node, NamedSurface& surface, std::vector<std::string>& warnings);

// Takes away sets of nodes that a writer made of sets of faces: those of a face set's name with that ending, if they
// hold exactly its nodes.
void drop_nodes_of_face_sets(TetMesh& mesh, const std::string& ending);

}  // namespace scan2fea
