// Triangles that are cut into smaller ones where a curve runs over them, whatever shares their edges.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scan2fea {

// An edge may have any number of triangles, as where bodies meet. The shape stays, to the rounding of new points.
class SplitSurface {
 public:
  explicit SplitSurface(SurfaceMesh mesh);

  const SurfaceMesh& mesh() const { return mesh_; }
  const Vec3& point(std::uint32_t v) const { return mesh_.vertices[v]; }
  const Triangle& triangle(std::uint32_t f) const { return mesh_.triangles[f]; }
  // Of the mesh given, the triangle that this one is a part of; and the parts of that one.
  std::uint32_t origin(std::uint32_t f) const { return origin_[f]; }
  std::span<const std::uint32_t> parts(std::uint32_t given) const { return parts_[given]; }
  // Per triangle the one, of a smaller number or itself, that it was last split from.
  std::uint32_t split_from(std::uint32_t f) const { return split_from_[f]; }
  std::span<const std::uint32_t> around(std::uint32_t v) const { return around_[v]; }
  bool has_edge(std::uint32_t a, std::uint32_t b) const;

  // Both return the new vertex. Of an edge, all triangles are split.
  std::uint32_t split_edge(std::uint32_t a, std::uint32_t b, const Vec3& point);
  std::uint32_t split_triangle(std::uint32_t f, const Vec3& point);

  // The vertex, old or new, at a point on the triangle of the mesh given: what is nearer than `snap` to a vertex or an
  // edge of its parts goes there.
  std::uint32_t insert(std::uint32_t given, const Vec3& point, double snap);

 private:
  std::uint32_t add_vertex(const Vec3& point);
  std::uint32_t add_part(std::uint32_t of, const Triangle& corners);
  void replace_corner(std::uint32_t f, std::uint32_t old, std::uint32_t v);

  SurfaceMesh mesh_;
  std::vector<std::uint32_t> origin_, split_from_;
  std::vector<std::vector<std::uint32_t>> parts_, around_;
};

}  // namespace scan2fea
