// What of another body faces a place of a surface.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "quality/triangle_tree.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace scan2fea {

// Where a place meets the other body's surface.
struct Foot {
  Vec3 point;
  double height;           // of the place over the triangle: above 0 a gap, below 0 an overlap
  std::uint32_t triangle;  // of the other mesh
};

class FacingSurface {
 public:
  // Of the listed triangles of the mesh. `fuzz`: a length that is nothing, against rounding.
  FacingSurface(const SurfaceMesh& mesh, std::span<const std::uint32_t> triangles, double fuzz);

  // The nearest point, at most `reach` away, of a triangle that faces `place`, whose unit normal is given; nothing
  // where that point is on the rim of what faces it and the place lies beyond.
  std::optional<Foot> under(const Vec3& place, const Vec3& normal, double reach) const;

  const Vec3& normal(std::uint32_t triangle) const { return normals_[triangle]; }
  const BoundingBox& box() const { return box_; }

 private:
  const SurfaceMesh& mesh_;
  TriangleTree tree_;
  std::vector<Vec3> normals_;
  BoundingBox box_;
  double fuzz_;
};

// Cosine between the normals of two surfaces that touch, turned about, at the least: within 32 degrees. Two polygons of
// 16 sides for one circle differ by 22; a chamfer at a rim departs by more.
inline constexpr double facing = 0.85;

}  // namespace scan2fea
