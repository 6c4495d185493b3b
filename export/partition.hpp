// The elements of a mesh in parts, one for each process of a parallel solver.
//
// METIS divides the dual graph, of elements that share a face, by its multilevel k-way scheme: parts of one size with
// few faces between them (G. Karypis and V. Kumar, Multilevel k-way partitioning scheme for irregular graphs, Journal
// of Parallel and Distributed Computing 48, 1998). Each element is in one part; nodes on the faces between parts are in
// several, so that there are no halos (ghost cells).
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// By how much the largest part may exceed the mean where METIS reaches its aim; that it does is not guaranteed.
inline constexpr double largest_part_of_mean = 1.03;

// Throws WrongUsage where so many elements cannot be in so many parts: none, more than elements, or more of either than
// the 32-bit numbers of METIS count.
void require_partition(std::uint64_t elements, std::uint64_t parts);

// The part of each element, from 0 on; none is empty. Parts hang together by faces if the mesh does and there are at
// least sixteen elements a part; fewer are cut into blocks of one size in the order in which they are met from the
// first one on. The same on every machine with the same METIS. Throws as `require_partition` does, and NotMeshable
// where METIS fails. METIS runs in a process of its own, O(n) of time and memory.
std::vector<std::uint32_t> partition(const std::vector<Tetrahedron>& tetrahedra, std::size_t parts);

// Orders the elements by parts, and within them as they were; sets and boundary go along. Returns how many each part
// has, as FileOptions::part_sizes wants it. Throws as `partition` does; the mesh is then untouched.
std::vector<std::uint32_t> order_by_parts(TetMesh& mesh, std::size_t parts);

// One part of a mesh whose elements are ordered by parts.
struct MeshPart {
  std::uint32_t first_element = 0, elements = 0;
  std::vector<std::uint32_t> nodes;  // of its elements, ascending
  std::vector<std::uint32_t> faces;  // of the mesh's boundary, behind which its elements are, ascending
};

// Without any sizes the mesh is one part. Throws WrongUsage where they are not those of this mesh. O(n log n).
std::vector<MeshPart> parts_of(const TetMesh& mesh, std::span<const std::uint32_t> sizes);

// How many nodes are in several parts.
std::size_t shared_nodes(std::size_t nodes, std::span<const MeshPart> parts);

}  // namespace scan2fea
