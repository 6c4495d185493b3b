// Gives bit-identical points one vertex.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

// Vertices are numbered in the order in which their first point came. No tolerance: points that differ in the last bit
// stay apart, and the repair stitches what should have met.
class VertexWelder {
 public:
  // `expected` vertices cost no regrowth.
  explicit VertexWelder(std::size_t expected);

  // The vertex at `point`, -0 being 0. O(1) on average. Throws InvalidInput past 2^32 - 1 vertices.
  std::uint32_t add(const Vec3& point);

  // Begins to fetch the memory that `add` of this point will need; called some points ahead it hides the wait.
  void prefetch(const Vec3& point) const;

  std::vector<Vec3> take_vertices() { return std::move(vertices_); }

 private:
  // The upper half of the hash beside the vertex tells most strangers apart without a look at their coordinates, which
  // lie far off in memory.
  struct Slot {
    std::uint32_t tag;
    std::uint32_t vertex;
  };

  void grow();

  std::vector<Vec3> vertices_;
  std::vector<Slot> slots_;  // open addressing, at most three quarters full; a power of two of them
};

}  // namespace scan2fea
