// Face normals without the noise of the vertices.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"
#include "preproc/surface/adjacency.hpp"

#include <vector>

namespace scan2fea {

struct NormalFilterOptions {
  int passes = 10;  // more flatten weak creases
  // Neighbours whose normals differ by more than about this count little: half of the angle of the creases that are to
  // stay, degrees.
  double same_side_deg = 20;
};

// Sets each unit normal to the mean of those of the faces around its three vertices, weighted by area, by nearness and
// by likeness of normals, again and again; so sides of creases stay apart.
// Source: Zheng, Fu, Au, Tai, "Bilateral Normal Filtering for Mesh Denoising" (TVCG 2011), the local iterative scheme.
// Parallel, deterministic; linear.
void filter_normals(const SurfaceMesh& scan, const VertexStars& stars, std::vector<Vec3>& normals,
                    const NormalFilterOptions& options = {});

}  // namespace scan2fea
