// Runs the real CalculiX on an INP file, for tests: a linear static analysis of a part under its own weight, forces on
// nodes and prescribed displacements.
#pragma once

#include "preproc/mesh/tet_mesh.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace scan2fea::calculix {

// Whether `ccx` is installed; tests skip where it is not.
bool available();

// Units are those of the mesh's length with any consistent choice of the others: mm, N, t give MPa, t/mm^3, mm/s^2.
struct Material {
  double young;
  double poisson;
  double density;
};

struct AtNode {
  std::uint32_t node;  // by index from 0
  Vec3 value;
};

struct Analysis {
  std::filesystem::path mesh;          // an INP file, taken in by *INCLUDE
  std::vector<std::uint32_t> clamped;  // nodes that do not move, by index from 0
  Material material;
  Vec3 gravity = Vec3::Zero();          // acceleration; zero for none
  std::vector<AtNode> displacements{};  // prescribed
  std::vector<AtNode> forces{};
};

struct Solution {
  std::vector<Vec3> displacements;  // by node
  Vec3 clamped_force;               // CalculiX's total RF of the clamped nodes: reaction less the load on these nodes
};

// Throws std::runtime_error with what CalculiX printed if it does not end well.
Solution solve(const Analysis& analysis);

// The integral of each node's shape function: a node's share of the volume and so, times density and gravity, of the
// weight. By CalculiX's rules of integration, so that shares add up to the weight that CalculiX applies; for elements
// with straight edges this is exact, and a mid-edge node has a fifth of each element's volume, a corner minus a
// twentieth.
std::vector<double> node_volumes(const TetMesh& mesh);

}  // namespace scan2fea::calculix
