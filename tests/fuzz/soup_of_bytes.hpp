// A few dozen triangles, described by bytes: bodies and faces on a coarse grid, so that faces that coincide, lie in one
// plane or cross are common, and what happens to scans done to them.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace scan2fea::fuzz {

inline constexpr std::size_t most_triangles = 60;

// Reads bytes from the front; behind the end all are 0.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : rest_(bytes) {}
  bool empty() const { return rest_.empty(); }
  std::uint8_t next() {
    if (rest_.empty()) return 0;
    const std::uint8_t byte = rest_.front();
    rest_ = rest_.subspan(1);
    return byte;
  }
  std::size_t below(std::size_t count) { return next() % count; }

 private:
  std::span<const std::uint8_t> rest_;
};

// Takes all bytes, or as many as `most_triangles` need.
SurfaceMesh soup_of(Bytes& bytes);

}  // namespace scan2fea::fuzz
