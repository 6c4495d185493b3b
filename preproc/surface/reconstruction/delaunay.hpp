// The Delaunay tetrahedralization of points, and surfaces of its triangles that CGAL's advancing front finds in it:
// Cohen-Steiner and Da, "A greedy Delaunay-based surface reconstruction algorithm", The Visual Computer 20, 2004.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace scan2fea {

// Tetrahedra as plain arrays. Those outside of the convex hull have one corner at infinity.
struct DelaunayCells {
  static constexpr std::uint32_t infinite = ~std::uint32_t{0};
  // Points' indices. The triangle opposite to corner i is `facet(cell, i)`.
  std::vector<std::array<std::uint32_t, 4>> corners;
  std::vector<std::array<std::uint32_t, 4>> neighbours;  // across the triangle opposite to each corner

  // Counter-clockwise seen from outside the cell.
  Triangle facet(std::uint32_t cell, std::size_t opposite) const;
  bool is_infinite(std::uint32_t cell) const;
  // The cells about the edge ab, in order, from one that has it.
  std::vector<std::uint32_t> around(std::uint32_t cell, std::uint32_t a, std::uint32_t b) const;
};

class Delaunay {
 public:
  // Points should differ. O(n log n): about 10 us and 1 kB a point; CGAL offers no way to stop it.
  explicit Delaunay(const std::vector<Vec3>& points);
  ~Delaunay();
  Delaunay(const Delaunay&) = delete;
  Delaunay& operator=(const Delaunay&) = delete;

  // Whether all points lie in a plane: there are no tetrahedra then, and no front.
  bool is_flat() const;

  DelaunayCells cells() const;

  // A front from which triangles are added one by one, those first that continue it most smoothly, or else have the
  // least radius: an oriented manifold, mostly with borders, of components each of which may face inwards. Not all
  // points need be used. Triangles that bend by less than `beta`, radians, are compared by their radius alone. The same
  // in every run. About 10 us a point.
  std::vector<Triangle> advancing_front(double beta) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace scan2fea
