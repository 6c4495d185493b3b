// Face normals without the noise of the vertices.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/kernel/adjacency.hpp"

#include <cstdint>
#include <vector>

namespace scan2fea {

struct NormalFilterOptions {
  int passes = 5;  // more of them flatten weak creases
  // Neighbours whose normals differ by more than about this count little, degrees. Less keeps weaker creases, and makes
  // steps where a curved surface is noisy.
  double same_side_deg = 20;
};

// Sets each normal to the mean of those of the faces around its triangle's vertices, weighted by area, by nearness and
// by likeness of normals, again and again, so that the sides of creases stay apart.
// Source: Zheng, Fu, Au, Tai, "Bilateral Normal Filtering for Mesh Denoising" (TVCG 2011), the local iterative scheme.
class NormalFilter {
 public:
  // For these faces; normals of others stay. Keeps no reference to the scan. Linear in the faces' rings.
  NormalFilter(const SurfaceMesh& scan, const VertexStars& stars, std::vector<std::uint32_t> faces);

  // `normals`: unit, one for each face of the scan. Parallel, deterministic.
  void apply(std::vector<Vec3>& normals, const NormalFilterOptions& options = {}) const;

 private:
  std::vector<std::uint32_t> faces_;
  std::vector<double> areas_;
  std::vector<std::size_t> first_;  // of the ring of each
  std::vector<std::uint32_t> ring_;
  std::vector<double> weight_;  // what is the same in all passes
};

}  // namespace scan2fea
