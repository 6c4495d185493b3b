#include "preproc/volume/edge_removal.hpp"

#include "preproc/volume/tet_quality.hpp"

#include <algorithm>
#include <limits>

namespace scan2fea {
namespace {

using Ring = TetComplex::Ring;
constexpr std::size_t capacity = Ring::capacity;

// best[i][j]: the largest smallest quality over triangulations of the ring's polygon from vertex i to vertex j, and the
// vertex that makes a triangle with that side.
struct Triangulation {
  std::array<std::array<double, capacity>, capacity> best;
  std::array<std::array<std::uint8_t, capacity>, capacity> apex;
};

// The two elements over and under a triangle of the ring, the lesser quality of both; exact only above `floor`.
double triangle_quality(const TetComplex& complex, const Ring& ring, std::size_t i, std::size_t k, std::size_t j,
                        double floor) {
  const Vec3& p = complex.node(ring.vertices[i]);
  const Vec3& q = complex.node(ring.vertices[k]);
  const Vec3& r = complex.node(ring.vertices[j]);
  const double over = goal_quality(p, q, r, complex.node(ring.b), floor);
  if (over <= floor) return over;
  return std::min(over, goal_quality(p, r, q, complex.node(ring.a), floor));
}

Triangulation triangulate(const TetComplex& complex, const Ring& ring, double floor) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Triangulation result;
  for (std::size_t i = 0; i + 1 < ring.size; ++i) result.best[i][i + 1] = infinity;
  for (std::size_t span = 2; span < ring.size; ++span)
    for (std::size_t i = 0; i + span < ring.size; ++i) {
      const std::size_t j = i + span;
      double best = floor;
      std::uint8_t apex = 0;
      for (std::size_t k = i + 1; k < j; ++k) {
        const double sides = std::min(result.best[i][k], result.best[k][j]);
        if (sides <= best) continue;
        const double quality = std::min(sides, triangle_quality(complex, ring, i, k, j, best));
        if (quality <= best) continue;
        best = quality;
        apex = static_cast<std::uint8_t>(k);
      }
      result.best[i][j] = apex == 0 ? -infinity : best;
      result.apex[i][j] = apex;
    }
  return result;
}

struct FreshList {
  std::array<TetComplex::Fresh, 2 * (capacity - 2)> elements;
  std::size_t size = 0;
};

void collect(const TetComplex& complex, const Ring& ring, const Triangulation& triangulation, std::size_t i,
             std::size_t j, FreshList& fresh) {
  if (j < i + 2) return;
  const std::size_t k = triangulation.apex[i][j];
  for (const Tetrahedron& t : {Tetrahedron{ring.vertices[i], ring.vertices[k], ring.vertices[j], ring.b},
                               Tetrahedron{ring.vertices[i], ring.vertices[j], ring.vertices[k], ring.a}})
    fresh.elements[fresh.size++] = {
        t, goal_quality(complex.node(t[0]), complex.node(t[1]), complex.node(t[2]), complex.node(t[3]))};
  collect(complex, ring, triangulation, i, k, fresh);
  collect(complex, ring, triangulation, k, j, fresh);
}

}  // namespace

bool remove_edge(TetComplex& complex, std::uint32_t t, std::size_t i, std::size_t j, double gain, std::uint32_t tried) {
  Ring ring;
  if (!complex.ring(t, i, j, ring) || ring.size < 3) return false;
  double before = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < ring.size; ++k) {
    const TetComplex::Element& element = complex.element(ring.elements[k]);
    if (element.tried & tried) return false;
    before = std::min(before, element.quality);
  }
  const double floor = std::max(before * gain, 0.0);
  const Triangulation triangulation = triangulate(complex, ring, floor);
  if (!(triangulation.best[0][ring.size - 1] > floor)) return false;
  FreshList fresh;
  collect(complex, ring, triangulation, 0, ring.size - 1, fresh);
  complex.replace(std::span(ring.elements).first(ring.size), std::span(fresh.elements).first(fresh.size));
  return true;
}

}  // namespace scan2fea
