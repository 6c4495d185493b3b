#include "preproc/volume/jacobian_bounds.hpp"

#include <numeric>

namespace scan2fea {

std::array<double, 20> jacobian_coefficients(const std::array<Vec3, 4>& corners, const std::array<Vec3, 6>& middles) {
  // The quadratic map's own Bernstein control points.
  std::array<std::array<Vec3, 4>, 4> control;
  for (std::size_t i = 0; i < 4; ++i) control[i][i] = corners[i];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto i = static_cast<std::size_t>(tetrahedron_edges[e][0]),
               j = static_cast<std::size_t>(tetrahedron_edges[e][1]);
    control[i][j] = control[j][i] = 2 * middles[e] - (corners[i] + corners[j]) / 2;
  }
  // Its three derivatives are linear: column k takes the value d[k][j] at corner j.
  std::array<std::array<Vec3, 4>, 3> d;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t j = 0; j < 4; ++j) d[k][j] = 2 * (control[j][k + 1] - control[j][0]);
  // The determinant is their product: a coefficient is the mean over the ways to deal its three indices out.
  const auto det = [&](std::size_t i, std::size_t j, std::size_t k) { return d[0][i].cross(d[1][j]).dot(d[2][k]); };
  const auto mean = [&](std::size_t i, std::size_t j, std::size_t k) {
    return (det(i, j, k) + det(j, k, i) + det(k, i, j) + det(i, k, j) + det(k, j, i) + det(j, i, k)) / 6;
  };
  std::array<double, 20> coefficients;
  std::size_t n = 0;
  for (std::size_t i = 0; i < 4; ++i) coefficients[n++] = det(i, i, i);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      if (i != j) coefficients[n++] = mean(i, i, j);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      for (std::size_t k = j + 1; k < 4; ++k) coefficients[n++] = mean(i, j, k);
  return coefficients;
}

std::array<double, 20> jacobian_coefficients(const TetMesh& mesh, std::size_t t) {
  std::array<Vec3, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = mesh.nodes[mesh.tetrahedra[t][k]];
  std::array<Vec3, 6> middles;
  for (std::size_t e = 0; e < 6; ++e) middles[e] = mesh.nodes[mesh.mid_edge_nodes[t][e]];
  return jacobian_coefficients(corners, middles);
}

double curved_volume(const TetMesh& mesh) {
  if (mesh.order() == 1) return total_volume(mesh);
  double volume = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const std::array<double, 20> c = jacobian_coefficients(mesh, t);
    volume += std::accumulate(c.begin(), c.end(), 0.0) / (20 * 6);
  }
  return volume;
}

}  // namespace scan2fea
