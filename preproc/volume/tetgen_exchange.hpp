// What the command and its TetGen worker pass to one another, as files in the byte order of the machine: both ends are
// of the same build and run side by side, so nothing else ever reads them.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace scan2fea {

// TetGen's input: the surface's vertices come first, then the interior points. Triangle i is facet i, marked i + 1.
struct TetgenInput {
  std::string switches;  // as on TetGen's command line, without the dash
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
};

// All points of the input in their order (used or not), then those that TetGen added. Tetrahedra in TetGen's
// orientation, which is not ours.
struct TetgenOutput {
  std::vector<Vec3> points;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Triangle> faces;             // the input's facets as they stand in the mesh, in no order or orientation
  std::vector<std::uint32_t> face_marker;  // per face, the input triangle + 1
};

// How the worker ended; 128 + signal where it was killed.
enum class TetgenStatus : int {
  success = 0,
  out_of_memory = 11,
  internal_error = 12,
  self_intersection = 13,
  tiny_feature = 14,
  close_facets = 15,
  wrong_input = 20,
  file_error = 21,
};

// These throw IoError (a full disk, a short file).
void write_exchange(const TetgenInput& input, const std::filesystem::path& file);
void write_exchange(const TetgenOutput& output, const std::filesystem::path& file);
TetgenInput read_tetgen_input(const std::filesystem::path& file);
TetgenOutput read_tetgen_output(const std::filesystem::path& file);

}  // namespace scan2fea
