// The elements of worst shape: which, where, and what is likely to have made them so.
#pragma once

#include "quality/element_measures.hpp"
#include "quality/tetrahedron_measures.hpp"
#include "quality/triangle_measures.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scan2fea {

struct WorstTetrahedron {
  std::uint32_t index;
  TetShape shape;
  Vec3 place;         // the middle of its corners
  std::string cause;  // a guess from what lies around it, in words
};

struct WorstTriangle {
  std::uint32_t index;
  TriangleShape shape;
  Vec3 place;
  std::string cause;
};

// Those of least scaled Jacobian, and of least smallest angle, the worst first and of equals the first; no triangles
// without area, which have no shape. `measures` are the mesh's. O(n).
std::vector<WorstTetrahedron> worst_tetrahedra(const TetMesh& mesh, const ElementMeasures& measures, std::size_t count);
std::vector<WorstTriangle> worst_triangles(const ElementMeasures& measures, std::size_t count);

// The names of the sets that have one of these members.
std::vector<std::string> sets_with(std::span<const NamedSet> sets, std::span<const std::uint32_t> members);

// The places in TetMesh::boundary of an element's outer faces.
std::vector<std::uint32_t> outer_faces_of(const TetMesh& mesh, std::uint32_t tetrahedron);

}  // namespace scan2fea
