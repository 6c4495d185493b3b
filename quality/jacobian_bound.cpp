#include "quality/jacobian_bound.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scan2fea {
namespace {

// The polar form (blossom) of the cubic on a sub-tetrahedron, at its corners i, j, k: symmetric, linear in each, equal
// to the Bernstein coefficient of the monomial i j k, and to the polynomial's value where i = j = k.
struct Cell {
  std::array<double, 64> blossom;  // [16 i + 4 j + k]
  std::array<Vec3, 4> corners;     // in the element's own coordinates
  double lower;                    // the smallest coefficient

  double value_at_corner(std::size_t i) const { return blossom[21 * i]; }
};

void set_lower(Cell& cell) {
  cell.lower = *std::min_element(cell.blossom.begin(), cell.blossom.end());
}

Cell whole_element(const CurvedTetrahedron& nodes) {
  // Control points of the quadratic map in Bernstein form: the corners, and 2 m - (a + b) / 2 for the edges.
  std::array<std::array<Vec3, 4>, 4> control;
  for (std::size_t i = 0; i < 4; ++i) control[i][i] = nodes[i];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto i = static_cast<std::size_t>(tetrahedron_edges[e][0]),
               j = static_cast<std::size_t>(tetrahedron_edges[e][1]);
    control[i][j] = control[j][i] = 2 * nodes[4 + e] - 0.5 * (nodes[i] + nodes[j]);
  }
  // derivative[k][i]: by the k-th local coordinate, at corner i; linear between the corners.
  std::array<std::array<Vec3, 4>, 3> derivative;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 4; ++i) derivative[k][i] = 2 * (control[i][k + 1] - control[i][0]);

  Cell cell;
  std::array<double, 64> det;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      const Vec3 normal = derivative[0][i].cross(derivative[1][j]);
      for (std::size_t k = 0; k < 4; ++k) det[16 * i + 4 * j + k] = normal.dot(derivative[2][k]);
    }
  const auto at = [&](std::size_t i, std::size_t j, std::size_t k) { return det[16 * i + 4 * j + k]; };
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k)
        cell.blossom[16 * i + 4 * j + k] =
            (at(i, j, k) + at(i, k, j) + at(j, i, k) + at(j, k, i) + at(k, i, j) + at(k, j, i)) / 6;
  cell.corners = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  set_lower(cell);
  return cell;
}

// The cell with corner `moved` replaced by the middle of its edge to `kept`: the blossom is linear in each argument.
Cell half(Cell cell, std::size_t kept, std::size_t moved) {
  auto& b = cell.blossom;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      b[16 * moved + 4 * i + j] = 0.5 * (b[16 * moved + 4 * i + j] + b[16 * kept + 4 * i + j]);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      b[16 * i + 4 * moved + j] = 0.5 * (b[16 * i + 4 * moved + j] + b[16 * i + 4 * kept + j]);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      b[16 * i + 4 * j + moved] = 0.5 * (b[16 * i + 4 * j + moved] + b[16 * i + 4 * j + kept]);
  cell.corners[moved] = 0.5 * (cell.corners[moved] + cell.corners[kept]);
  set_lower(cell);
  return cell;
}

std::array<std::size_t, 2> longest_edge(const Cell& cell) {
  std::array<std::size_t, 2> longest{0, 1};
  double length2 = -1;
  for (const auto& [i, j] : tetrahedron_edges) {
    const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(j);
    const double candidate = (cell.corners[from] - cell.corners[to]).squaredNorm();
    if (candidate > length2) {
      length2 = candidate;
      longest = {from, to};
    }
  }
  return longest;
}

}  // namespace

JacobianBound min_jacobian_bound(const CurvedTetrahedron& nodes, double tolerance, JacobianWanted wanted) {
  std::vector<Cell> heap{whole_element(nodes)};
  double scale = 0;
  for (const double b : heap[0].blossom) scale = std::max(scale, std::abs(b));
  double upper = heap[0].value_at_corner(0);
  for (std::size_t i = 1; i < 4; ++i) upper = std::min(upper, heap[0].value_at_corner(i));

  // The cell with the smallest coefficient is the only one that holds the bound down, so it is the one to split.
  const auto higher = [](const Cell& a, const Cell& b) { return a.lower > b.lower; };
  for (;;) {
    const double lower = heap.front().lower;
    const bool is_certain = wanted == JacobianWanted::sign && (lower > 0 || upper <= 0);
    if (is_certain || !(upper - lower > tolerance * scale)) return {lower, upper};
    std::pop_heap(heap.begin(), heap.end(), higher);
    const Cell cell = heap.back();
    heap.pop_back();
    const auto [i, j] = longest_edge(cell);
    heap.push_back(half(cell, i, j));
    upper = std::min(upper, heap.back().value_at_corner(j));
    std::push_heap(heap.begin(), heap.end(), higher);
    heap.push_back(half(cell, j, i));
    std::push_heap(heap.begin(), heap.end(), higher);
  }
}

}  // namespace scan2fea
