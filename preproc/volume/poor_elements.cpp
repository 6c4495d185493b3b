#include "preproc/volume/poor_elements.hpp"

#include "preproc/volume/interior_points.hpp"
#include "quality/tetrahedron_measures.hpp"

#include <algorithm>

namespace scan2fea {

std::vector<PoorElement> find_poor_elements(const TetMesh& mesh, const SurfaceMesh& surface,
                                            double least_dihedral_deg) {
  std::vector<PoorElement> poor;
  const std::vector<double> edge_at = surface_sizes(surface);
  for (const Tetrahedron& t : mesh.tetrahedra) {
    const Vec3 &a = mesh.nodes[t[0]], &b = mesh.nodes[t[1]], &c = mesh.nodes[t[2]], &d = mesh.nodes[t[3]];
    const double angle = measure_tetrahedron(a, b, c, d).min_dihedral_deg;
    if (angle >= least_dihedral_deg) continue;
    double sum = 0;
    int count = 0;
    for (const std::uint32_t v : t)
      if (v < edge_at.size()) {
        sum += edge_at[v];
        ++count;
      }
    if (count == 0) continue;
    const double longest =
        std::max({(b - a).norm(), (c - a).norm(), (d - a).norm(), (c - b).norm(), (d - b).norm(), (d - c).norm()});
    poor.push_back({angle, (a + b + c + d) / 4, longest, sum / count});
  }
  return poor;
}

}  // namespace scan2fea
