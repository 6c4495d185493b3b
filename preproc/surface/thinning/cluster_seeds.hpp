// Points all over a surface of any size, about evenly apart: the middles of what is thinned to one vertex each.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/thinning/sparse_grid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace scan2fea {

// The means of the vertices in each cell of a grid, but for those that are nearer than three fifths of a cell to that
// of more vertices: where a surface runs along a side of cells, noise would have it change between the two from vertex
// to vertex, and with it the vertices that they become. 70 bytes a cell.
class ClusterSeeds {
 public:
  // Cells of this edge length, from the lower corner of a box that holds all vertices. Precondition: the cell is above
  // a millionth of the box's diagonal.
  ClusterSeeds(const BoundingBox& box, double cell);

  // More triangles of the surface.
  void add(const SurfaceMesh& block);
  // Cells that hold a vertex so far. Surfaces fill about one and a half in the area of a cell's side.
  std::size_t cells() const { return cells_.size(); }

  // As if its cells had been so many times as wide from the start, but that what was in a cell stays together.
  ClusterSeeds widened(double times) const;

  // How thick the surface is, seen at the size of its cells, model units: the median of the RMS distances of the
  // vertices in a cell from their plane. Of a smooth surface with more vertices than cells that is its noise, or where
  // cells are wide what it bends in one. 0 where no cell has enough vertices to tell.
  double thickness() const;

  // After the last triangle: which cells' means are seeds.
  void choose();

  // Places in units of cells, from the box's lower corner.
  Vec3 in_cells(const Vec3& p) const { return (p - low_) / cell_; }
  Vec3 in_model(const Vec3& p) const { return low_ + cell_ * p; }
  double cell() const { return cell_; }

  std::size_t count() const { return seeds_.size(); }
  const Vec3& seed(std::uint32_t s) const { return seeds_[s]; }
  // Among the seeds in the cell of a place of the surface and in those about it; there is always one.
  std::uint32_t nearest(const Vec3& in_cells) const;

 private:
  struct Cell {
    SparseGrid::Place place;
    std::uint32_t vertices = 0;
    // From the cell's lower corner: the sum, and that of squares and products, xx, xy, xz, yy, yz, zz.
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    std::array<float, 6> products{};
  };

  Cell& cell_at(const SparseGrid::Place& place);
  static Vec3 mean(const Cell& cell);
  bool is_crowded(const Vec3& mean) const;
  template <class Visit>
  void for_each_about(const Vec3& in_cells, Visit&& visit) const;

  Vec3 low_;
  double cell_;
  std::vector<Cell> cells_;
  SparseGrid numbers_;  // of the cells; then of their seeds
  std::vector<Vec3> seeds_;
};

}  // namespace scan2fea
