// Names of sets as formats allow them, and the parts into which overlapping sets cut a mesh.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace scan2fea {

// NALL, EALL and SALL, which writers make of the mesh itself, and what INP makes SALL of; upper or lower case.
bool is_reserved_set(std::string_view name);

// The same with a prefix before them.
bool is_whole_set(std::string_view name, std::string_view prefix);

struct NameRules {
  std::size_t longest = 80;
  bool upper_case = false;
  std::string_view allowed = "_-.+";  // besides letters and digits; what is not becomes `_`
  bool starts_with_letter = true;
  bool keeps_reserved = false;  // of sets that `with_whole_sets` made
};

// The mesh with NALL, EALL and SALL as sets, for formats that have nothing else for them; the prefix goes before their
// names. Sets of these names are renamed, which is noted.
TetMesh with_whole_sets(const TetMesh& mesh, const std::string& prefix, std::vector<std::string>& notes);

// Before the names of all sets.
void put_prefix(const std::string& prefix, TetMesh& mesh);
void put_prefix(const std::string& prefix, NamedSurface& surface);

// The names of the sets that all files have, as INP has them, with a prefix before them: not for others.
std::vector<std::string> taken_with_prefix(const std::string& prefix);

// One per set and in their order: no two alike, whatever the case, nor one like those that are `taken`. Each change
// but that of case is told.
std::vector<std::string> names_for(std::span<const NamedSet> sets, const NameRules& rules,
                                   std::span<const std::string> taken, std::vector<std::string>& warnings);

// What the sets of a mesh are called in a file, in their order.
struct WrittenNames {
  std::vector<std::string> nodes, faces, elements;
};

// Members that are in the same sets are one part. Formats that give each element one number give that of its part.
struct SetParts {
  std::vector<std::uint32_t> part;             // per member; 0 is the part that is in no set
  std::vector<std::vector<std::uint32_t>> of;  // per part the indices of its sets, ascending; parts in order of these
};
SetParts set_parts(std::span<const NamedSet> sets, std::size_t members);

// Sets that share no member, in their order, each that shares none with those before; the others; and the members of
// none of the first.
struct DisjointSets {
  std::vector<std::size_t> disjoint, overlapping;  // sets without members are neither
  std::vector<std::uint32_t> rest;
};
DisjointSets disjoint_sets(std::span<const NamedSet> sets, std::size_t members);

// "A+B" for a part that is in both, as formats without another way to say so have it.
std::string part_name(const SetParts& parts, std::size_t part, std::span<const std::string> names);
inline constexpr char part_name_joint = '+';

// The names of the sets that `part_name` joined.
std::vector<std::string> split_part_name(std::string_view name);

}  // namespace scan2fea
