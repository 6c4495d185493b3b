// What the unit of a mesh is, and another one.
#pragma once

#include "export/mesh_file.hpp"

#include <optional>
#include <string>

namespace scan2fea {

// "mm:m": coordinates in millimetres become metres.
struct UnitScale {
  std::string from, to;
  double factor() const;
};

// Throws WrongUsage where the text is not of two units that `length_unit` knows.
UnitScale parse_unit_scale(const std::string& text);

// The unit of a file that says it is in `of_file` (empty: says nothing) and of which the user says the same or nothing.
// Throws WrongUsage where they differ: a unit is never relabelled.
std::string settled_unit(const std::string& of_file, const std::optional<std::string>& of_user,
                         const std::string& file);

// Throws WrongUsage where `file`, with which the mesh is compared, says another unit than the mesh.
void require_same_unit(const std::string& of_mesh, const std::string& of_file, const std::string& file);

// Multiplies all coordinates. Throws WrongUsage where the mesh is in another unit than the scale's.
void apply_scale(MeshFile& mesh, const UnitScale& scale, const std::string& file);

// A sentence where the size is one that no scanner sees or no part has: most likely the unit is wrong.
std::optional<std::string> implausible_size(double diagonal, const std::string& unit);

}  // namespace scan2fea
