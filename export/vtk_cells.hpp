// What the readers of VTK's formats gather, on the way to a mesh.
#pragma once

#include "export/mesh_file.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace scan2fea {

inline constexpr std::uint64_t vtk_triangle = 5, vtk_triangle_strip = 6, vtk_polygon = 7, vtk_tetra = 10,
                               vtk_quadratic_tetra = 24;

// How the arrays of sets are named.
inline constexpr std::string_view vtk_node_set = "node_set ", vtk_element_set = "element_set ",
                                  vtk_face_set = "face_set ";

// Of the pieces of a mesh: numbers that are the same in all of them, and which piece a cell is in.
inline constexpr std::string_view vtk_global_nodes = "GlobalNodeIds", vtk_global_elements = "GlobalElementIds",
                                  vtk_part = "part";

struct VtkCells {
  std::vector<double> coordinates;          // three per point
  std::vector<std::uint64_t> connectivity;  // points of all cells
  std::vector<std::uint64_t> offsets;       // where each cell ends in it
  std::vector<std::uint64_t> types;         // VTK's, per cell
  // Those of sets, in the order of the file.
  std::vector<std::pair<std::string, std::vector<double>>> point_arrays, cell_arrays;
  std::vector<std::string> other_arrays;    // names
  std::vector<std::uint64_t> global_nodes;  // numbers of the points in the whole mesh, where the file has them
  std::string unit;
};

// Throws InvalidInput for what is wrong with a file as a whole.
[[noreturn]] void fail_vtk(const std::filesystem::path& file, std::string what, std::string value = {},
                           std::string advice = {});

// Of an XML file of one piece. Throws InvalidInput as the readers say.
VtkCells read_vtk_cells(const std::filesystem::path& file);

// Throws InvalidInput as the readers say.
MeshFile mesh_of(const VtkCells& cells, const std::filesystem::path& file);

}  // namespace scan2fea
