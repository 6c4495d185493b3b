// Names for parts of a mesh: where it is clamped, where it is loaded, what is another material.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

// Indices from 0 of what the list that holds the set says: nodes, faces or elements. Sorted, each once. The name is as
// the user or the file gave it, not empty; each writer makes of it what its format allows.
struct NamedSet {
  std::string name;
  std::vector<std::uint32_t> members;

  bool operator==(const NamedSet&) const = default;
};

// What a surface's file holds besides the surface itself, which stays plain since hot loops copy it.
struct NamedSurface {
  SurfaceMesh mesh;
  std::vector<NamedSet> node_sets;  // of mesh.vertices
  std::vector<NamedSet> face_sets;  // of mesh.triangles
  std::string unit;                 // of length; empty where it is not known
};

// A set whose members may come in any order and more than once.
NamedSet named_set(std::string name, std::vector<std::uint32_t> members);

// The place of the set with this name, upper or lower case, in the list; its size where there is none. Two sets of one
// kind never differ by case alone, since solvers do not tell them apart.
std::size_t find_set(std::span<const NamedSet> sets, std::string_view name);

// The same; where there is none, it is made.
std::size_t find_or_add_set(std::vector<NamedSet>& sets, std::string_view name);

// The sets of a mesh that was made of another one. `origin`: per member of the new mesh what it was in the old one; of
// what is new, any number that is no member. A set that nothing is left of stays, empty.
std::vector<NamedSet> carried_sets(std::span<const NamedSet> sets, std::span<const std::uint32_t> origin);

// Vertices of the triangles of a set, sorted.
std::vector<std::uint32_t> vertices_of_faces(const SurfaceMesh& mesh, std::span<const std::uint32_t> faces);

}  // namespace scan2fea
