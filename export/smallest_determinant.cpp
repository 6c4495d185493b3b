#include "export/smallest_determinant.hpp"

#include <array>
#include <limits>

namespace scan2fea {
namespace {

// Derivatives of the ten shape functions (rows) by r, s, t (columns) at a point of the reference tetrahedron, whose
// barycentric coordinates are (1 - r - s - t, r, s, t): N = L (2 L - 1) for corners, N = 4 Li Lj for mid-edges.
using ShapeDerivatives = Eigen::Matrix<double, 10, 3>;

ShapeDerivatives shape_derivatives(const Vec3& point) {
  const Eigen::Vector4d l(1 - point.sum(), point.x(), point.y(), point.z());
  Eigen::Matrix<double, 4, 3> dl;
  dl << -1, -1, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  ShapeDerivatives derivatives;
  for (int i = 0; i < 4; ++i) derivatives.row(i) = (4 * l[i] - 1) * dl.row(i);
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = tetrahedron_edges[static_cast<std::size_t>(e)];
    derivatives.row(4 + e) = 4 * (l[i] * dl.row(j) + l[j] * dl.row(i));
  }
  return derivatives;
}

}  // namespace

SmallestDeterminant smallest_determinant(const TetMesh& mesh) {
  // CalculiX integrates C3D10 at the four points of the rule of degree 2.
  constexpr double a = 0.138196601125010515;
  constexpr double b = 1 - 3 * a;
  const std::array<ShapeDerivatives, 4> at_points{shape_derivatives({a, a, a}), shape_derivatives({b, a, a}),
                                                  shape_derivatives({a, b, a}), shape_derivatives({a, a, b})};
  SmallestDeterminant smallest{std::numeric_limits<double>::infinity(), 0};
  const auto consider = [&](double determinant, std::size_t t) {
    if (determinant < smallest.value) smallest = {determinant, static_cast<std::uint32_t>(t)};
  };
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& corners = mesh.tetrahedra[t];
    if (mesh.order() == 1) {
      const Vec3& p = mesh.nodes[corners[0]];
      consider((mesh.nodes[corners[1]] - p).cross(mesh.nodes[corners[2]] - p).dot(mesh.nodes[corners[3]] - p), t);
      continue;
    }
    Eigen::Matrix<double, 3, 10> nodes;
    for (int i = 0; i < 4; ++i) nodes.col(i) = mesh.nodes[corners[static_cast<std::size_t>(i)]];
    for (int e = 0; e < 6; ++e) nodes.col(4 + e) = mesh.nodes[mesh.mid_edge_nodes[t][static_cast<std::size_t>(e)]];
    for (const ShapeDerivatives& derivatives : at_points) {
      const Eigen::Matrix3d jacobian = nodes * derivatives;
      consider(jacobian.determinant(), t);
    }
  }
  return smallest;
}

}  // namespace scan2fea
