// What is plane on the scan is plane on the surface made of it.
#pragma once

#include "preproc/surface/features/feature_net.hpp"
#include "preproc/surface/features/plane_regions.hpp"
#include "quality/triangle_tree.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace scan2fea {

// Numbers of planes, ascending.
using PlaneNumbers = std::vector<std::uint32_t>;

// Vertices of a surface that stand for places in planes of the scan.
struct VerticesOnPlanes {
  std::vector<Vec3> places;  // per vertex of the surface: on its planes, or where it is
  // Per vertex, its move when all planes move outwards by one: what keeps them plane. Zero where it is on none.
  std::vector<Vec3> outwards;
};

class PlanesOfScan {
 public:
  PlanesOfScan() = default;  // none
  // `scan` need not outlive it. `edge`: mean one of the surfaces that will be asked about. See find_plane_regions.
  PlanesOfScan(const SurfaceMesh& scan, double noise, double edge);

  bool empty() const { return regions_.list.empty(); }

  // Per vertex. It lies in a plane if the nearest place of the scan does; on a line between planes it lies in all of
  // them. Borders stay, and so does what would go farther than a fifth of an edge. O(n log n).
  std::vector<PlaneNumbers> planes_of(const SurfaceMesh& surface, const FeatureNet& net) const;
  VerticesOnPlanes vertices_of(const SurfaceMesh& surface, const FeatureNet& net) const;

  // The shortest step from p onto these planes, of which those within 15 degrees of one another count as one.
  Vec3 step_onto(const PlaneNumbers& planes, const Vec3& p) const;

 private:
  std::uint32_t region_at(const Vec3& p, const Vec3& normal, double edge) const;

  PlaneRegions regions_;
  std::optional<TriangleTree> tree_;  // of what is plane
};

}  // namespace scan2fea
