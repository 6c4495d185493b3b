// What the readers of all formats gather, and its check on the way to a TetMesh.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace scan2fea {

// Nodes by number, in any order; elements as node numbers in the order of Abaqus and VTK.
struct RawMesh {
  std::vector<std::uint64_t> node_numbers;
  std::vector<Vec3> nodes;
  std::vector<std::uint64_t> corners;    // four per element
  std::vector<std::uint64_t> mid_edges;  // none, or six per element
};

// The tetrahedral mesh of those nodes that elements use, ordered by node number. `place_of_node` and
// `place_of_element` turn an index into RawMesh's arrays into words for messages, "part.inp:12".
// Throws InvalidInput: no elements, some elements of first and some of second order, a node number that is defined
// twice or not at all, a node repeated in an element, coordinates that are not finite. O(n log n).
TetMesh assemble(const RawMesh& raw, const std::filesystem::path& file,
                 const std::function<std::string(std::size_t)>& place_of_node,
                 const std::function<std::string(std::size_t)>& place_of_element);

}  // namespace scan2fea
