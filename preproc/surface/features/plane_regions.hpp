// The plane faces of a scan, as far as its noise lets them be told.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace scan2fea {

inline constexpr std::uint32_t no_plane = std::numeric_limits<std::uint32_t>::max();

struct Plane {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  // unit, outwards

  double height(const Vec3& p) const { return normal.dot(p - point); }
};

struct PlaneRegions {
  std::vector<Plane> list;
  std::vector<std::uint32_t> of_triangle;  // its place in the list, or no_plane; empty where the list is
  double tolerance = 0;                    // model units: vertices of a region are within this of its plane
};

// Connected triangles whose vertices lie within four times the noise of the plane through them, or within the rounding
// of 32-bit coordinates where that is more, that do not bend by more than half of the noise, and that are wider than
// `edge` or end at creases: else a facet of a round surface would count. `noise`: standard deviation, model units (see
// scan_noise.hpp). Where a plane passes smoothly into a rounding, it ends where that has left it by the tolerance.
// Deterministic; linear in the scan. Not guaranteed: planes of less than a two-thousandth of a scan without larger
// ones.
PlaneRegions find_plane_regions(const SurfaceMesh& scan, double noise, double edge);

}  // namespace scan2fea
