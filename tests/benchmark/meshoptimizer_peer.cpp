#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/benchmark/peers.hpp"

#include <meshoptimizer.h>
#include <vector>

namespace scan2fea::benchmark {

// The library reads and writes no files; ours stand in.
void meshoptimizer_simplify(const PeerJob& job) {
  SurfaceMesh mesh = read_surface(job.input);
  std::vector<float> positions;
  for (const Vec3& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(v[k]));
  std::vector<unsigned> indices;
  for (const Triangle& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  std::vector<unsigned> simplified(indices.size());
  simplified.resize(meshopt_simplify(simplified.data(), indices.data(), indices.size(), positions.data(),
                                     mesh.vertices.size(), 3 * sizeof(float), job.faces * 3, 1.0F));
  mesh.triangles.clear();
  for (std::size_t i = 0; i + 2 < simplified.size(); i += 3)
    mesh.triangles.push_back({simplified[i], simplified[i + 1], simplified[i + 2]});
  std::vector<std::uint32_t> renumbered(mesh.vertices.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const auto v : t) renumbered[v] = 1;
  std::vector<Vec3> used;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (renumbered[v] == 0) continue;
    renumbered[v] = static_cast<std::uint32_t>(used.size());
    used.push_back(mesh.vertices[v]);
  }
  mesh.vertices = std::move(used);
  for (Triangle& t : mesh.triangles)
    for (auto& v : t) v = renumbered[v];
  write_surface(mesh, job.output);
}

}  // namespace scan2fea::benchmark
