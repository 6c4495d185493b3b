// What the readers of all formats gather, and its check on the way to a mesh.
#pragma once

#include "export/mesh_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace scan2fea {

struct RawSet {
  std::string name;
  std::vector<std::uint64_t> members;  // numbers of the file, in any order, also more than once
};

struct RawFaceSet {
  std::string name;
  std::vector<std::pair<std::uint64_t, std::uint8_t>> faces;  // number of a tetrahedron, index into tetrahedron_faces
};

// Nodes by number, in any order; elements as node numbers in the order of Abaqus and VTK.
struct RawMesh {
  std::vector<std::uint64_t> node_numbers;
  std::vector<Vec3> nodes;
  std::vector<std::uint64_t> corners;    // of tetrahedra, four per element
  std::vector<std::uint64_t> mid_edges;  // none, or six per element
  std::vector<std::uint64_t> triangles;  // three corners per element; their mid-edge nodes are left out

  // By which `element_sets` name elements, one per tetrahedron and per triangle; no number is both. Where there are no
  // sets of elements they may be left out.
  std::vector<std::uint64_t> tetrahedron_numbers, triangle_numbers;

  // Sets of one name and kind are one set. In a set of elements the triangles are faces of tetrahedra, where the file
  // has tetrahedra.
  std::vector<RawSet> node_sets, element_sets;
  std::vector<RawFaceSet> face_sets;
  std::string unit;
  bool has_own_numbers = false;  // the numbers of nodes and elements are the file's, and not made up by its reader
  std::size_t passed_over = 0;   // elements that are neither tetrahedra nor triangles

  // Whether a tetrahedron of second order, or of first, is another one than those that there are.
  bool has_other_order(bool second) const { return !corners.empty() && second == mid_edges.empty(); }
  // Of four or ten nodes, and of no other order than those that there are.
  void add_tetrahedron(std::uint64_t number, std::span<const std::uint64_t> nodes);
};

// What a reader says of it.
inline constexpr const char* mixed_orders = "tetrahedra of first and of second order in one mesh";

// The set of that name; it is made where there is none.
std::vector<std::uint64_t>& members_of(std::vector<RawSet>& sets, const std::string& name);

// The mesh of those nodes that elements use, ordered by node number. `place_of_node` and `place_of_element` turn an
// index into RawMesh's arrays (of tetrahedra, or of triangles where there are none) into words for messages,
// "part.inp:12". The sets that all files of ours have (NALL, EALL, SALL) are left out.
// Throws InvalidInput: no elements, some elements of first and some of second order, a node number that is defined
// twice or not at all, a node repeated in an element, coordinates that are not finite. O(n log n).
MeshFile assemble(const RawMesh& raw, const std::filesystem::path& file,
                  const std::function<std::string(std::size_t)>& place_of_node,
                  const std::function<std::string(std::size_t)>& place_of_element);

// With "part.inp: node 7" and "part.inp: element 8" as places.
MeshFile assemble(const RawMesh& raw, const std::filesystem::path& file);

}  // namespace scan2fea
