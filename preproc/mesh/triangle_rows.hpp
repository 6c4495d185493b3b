// What a reader has made of the rows of a file so far.
#pragma once

#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/surface_mesh.hpp"

#include <algorithm>
#include <cstddef>

namespace scan2fea {

// The triangles, which with `take` go there block by block, after rows that readers say have ended.
class TriangleRows {
 public:
  explicit TriangleRows(const TakeBlock& take) : take_(take) {}

  SurfaceMesh mesh;

  // Of all triangles so far, those handed over too.
  std::size_t count() const { return handed_over_ + mesh.triangles.size(); }

  // How many of so many are here at a time.
  std::size_t at_once(std::size_t triangles) const { return take_ ? std::min(triangles, block) : triangles; }

  bool is_block() const { return take_ && mesh.triangles.size() >= block; }
  void hand_over() {
    take_(mesh);
    handed_over_ += mesh.triangles.size();
    mesh.triangles.clear();
  }
  void end_row() {
    if (is_block()) hand_over();
  }

  // The rest.
  SurfaceMesh finish() {
    if (take_ && !mesh.triangles.empty()) hand_over();
    return std::move(mesh);
  }

 private:
  // Enough that handing over costs nothing, few enough to stay in the cache.
  static constexpr std::size_t block = 1U << 15;

  const TakeBlock& take_;
  std::size_t handed_over_ = 0;
};

}  // namespace scan2fea
