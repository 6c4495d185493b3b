#include "quality/tetrahedron_measures.hpp"

#include "preproc/mesh/numbers.hpp"
#include "quality/jacobian_bound.hpp"
#include "quality/triangle_measures.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace scan2fea {
namespace {

// For each edge of tetrahedron_edges the two corners that are not on it.
constexpr std::array<std::array<std::size_t, 2>, 6> opposite{{{2, 3}, {0, 3}, {1, 3}, {1, 2}, {0, 2}, {0, 1}}};

// The edges (indices into tetrahedron_edges) that meet at each corner.
constexpr std::array<std::array<std::size_t, 3>, 4> edges_at_corner{{{0, 2, 3}, {0, 1, 4}, {1, 2, 5}, {3, 4, 5}}};

struct Extremes {
  double min_dihedral_deg = 180, max_dihedral_deg = 0;
  double min_face_angle_deg = 180, max_face_angle_deg = 0;
  double min_jacobian = 1, sum_jacobian = 0;
  double edge_ratio = 0, radius_edge_ratio = 0;
  std::size_t inverted = 0;
};

// Mid-edge nodes where straight edges have their middles, but for rounding.
bool is_straight(const CurvedTetrahedron& x) {
  constexpr double rounding = 1e-12;  // of an edge's length; coordinates may be far from the origin
  for (std::size_t e = 0; e < 6; ++e) {
    const Vec3 &a = x[static_cast<std::size_t>(tetrahedron_edges[e][0])],
               &b = x[static_cast<std::size_t>(tetrahedron_edges[e][1])];
    if ((x[4 + e] - 0.5 * (a + b)).norm() > rounding * (b - a).norm()) return false;
  }
  return true;
}

// Of a curved edge, by three points of Gauss: exact where it is straight.
double curve_length(const Vec3& a, const Vec3& middle, const Vec3& b) {
  const double far = std::sqrt(0.6);
  const auto speed = [&](double s) { return (0.5 * (b - a) + s * (a - 2 * middle + b)).norm(); };  // s from -1 to 1
  return (5 * speed(-far) + 8 * speed(0) + 5 * speed(far)) / 9;
}

// Between the faces that meet at an edge, at a point of it.
double dihedral_deg(const CurvedTetrahedron& x, std::size_t e, const std::array<double, 4>& at) {
  const auto [u, v, w] = derivatives_at(x, at);
  // Gradients of the barycentric coordinates times the Jacobian; each stands on the face where its coordinate is 0.
  std::array<Vec3, 4> normal{Vec3::Zero(), v.cross(w), w.cross(u), u.cross(v)};
  normal[0] = -(normal[1] + normal[2] + normal[3]);
  const Vec3 &n1 = normal[opposite[e][0]], &n2 = normal[opposite[e][1]];
  return degrees * std::atan2(n1.cross(n2).norm(), -n1.dot(n2));
}

std::array<double, 6> curve_lengths(const CurvedTetrahedron& x) {
  std::array<double, 6> length;
  for (std::size_t e = 0; e < 6; ++e)
    length[e] = curve_length(x[static_cast<std::size_t>(tetrahedron_edges[e][0])], x[4 + e],
                             x[static_cast<std::size_t>(tetrahedron_edges[e][1])]);
  return length;
}

TetShape measure_curved(const CurvedTetrahedron& x) {
  TetShape shape = measure_tetrahedron(x[0], x[1], x[2], x[3]);
  shape.min_dihedral_deg = 180;
  shape.max_dihedral_deg = 0;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto i = static_cast<std::size_t>(tetrahedron_edges[e][0]),
               j = static_cast<std::size_t>(tetrahedron_edges[e][1]);
    for (const double along : {0.0, 0.5, 1.0}) {
      std::array<double, 4> at{0, 0, 0, 0};
      at[i] = 1 - along;
      at[j] = along;
      const double angle = dihedral_deg(x, e, at);
      shape.min_dihedral_deg = std::min(shape.min_dihedral_deg, angle);
      shape.max_dihedral_deg = std::max(shape.max_dihedral_deg, angle);
    }
  }
  shape.scaled_jacobian = curved_scaled_jacobian(x);
  const std::array<double, 6> length = curve_lengths(x);
  if (shape.edge_ratio)
    shape.edge_ratio =
        *std::max_element(length.begin(), length.end()) / *std::min_element(length.begin(), length.end());
  return shape;
}

// Where the sign is not that of a bound that is close to the value, it is asked for.
bool is_inverted(const TetMesh& mesh, std::size_t t, const TetShape& shape) {
  if (shape.scaled_jacobian > 0 || mesh.order() == 1) return !(shape.scaled_jacobian > 0);
  return !(min_jacobian_bound(curved_tetrahedron(mesh, t)).lower > 0);
}

Extremes measure_range(const TetMesh& mesh, std::size_t begin, std::size_t end) {
  Extremes extremes;
  for (std::size_t i = begin; i < end; ++i) {
    const TetShape shape = measure_tetrahedron(mesh, i);
    extremes.min_dihedral_deg = std::min(extremes.min_dihedral_deg, shape.min_dihedral_deg);
    extremes.max_dihedral_deg = std::max(extremes.max_dihedral_deg, shape.max_dihedral_deg);
    const Tetrahedron& corners = mesh.tetrahedra[i];
    const FaceAngles angles = measure_face_angles(mesh.nodes[corners[0]], mesh.nodes[corners[1]],
                                                  mesh.nodes[corners[2]], mesh.nodes[corners[3]]);
    extremes.min_face_angle_deg = std::min(extremes.min_face_angle_deg, angles.min_deg);
    extremes.max_face_angle_deg = std::max(extremes.max_face_angle_deg, angles.max_deg);
    extremes.min_jacobian = std::min(extremes.min_jacobian, shape.scaled_jacobian);
    extremes.sum_jacobian += shape.scaled_jacobian;
    extremes.edge_ratio = std::max(extremes.edge_ratio, shape.edge_ratio.value_or(0));
    extremes.radius_edge_ratio = std::max(extremes.radius_edge_ratio, shape.radius_edge_ratio.value_or(0));
    extremes.inverted += is_inverted(mesh, i, shape);
  }
  return extremes;
}

}  // namespace

TetShape measure_tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::array<Vec3, 4> corner{Vec3::Zero(), b - a, c - a, d - a};
  double scale = 0;
  for (const Vec3& p : corner) scale = std::max(scale, p.cwiseAbs().maxCoeff());
  if (!(scale > 0)) return {0, 180, 0, std::nullopt, std::nullopt};
  for (Vec3& p : corner) p /= scale;

  std::array<Vec3, 6> edge;
  std::array<double, 6> length;
  for (std::size_t e = 0; e < 6; ++e) {
    const auto& [from, to] = tetrahedron_edges[e];
    edge[e] = corner[static_cast<std::size_t>(to)] - corner[static_cast<std::size_t>(from)];
    length[e] = edge[e].norm();
  }
  const double six_volumes = corner[1].cross(corner[2]).dot(corner[3]);
  const auto [shortest, longest] = std::minmax_element(length.begin(), length.end());

  TetShape shape{180, 0, 0, std::nullopt, std::nullopt};
  for (std::size_t e = 0; e < 6; ++e) {
    // Between the faces through the edge; |n1 x n2| = |edge| * 6 volumes.
    const Vec3& from = corner[static_cast<std::size_t>(tetrahedron_edges[e][0])];
    const Vec3 n1 = edge[e].cross(corner[opposite[e][0]] - from);
    const Vec3 n2 = edge[e].cross(corner[opposite[e][1]] - from);
    const double angle = degrees * std::atan2(length[e] * std::abs(six_volumes), n1.dot(n2));
    shape.min_dihedral_deg = std::min(shape.min_dihedral_deg, angle);
    shape.max_dihedral_deg = std::max(shape.max_dihedral_deg, angle);
  }

  double largest_product = 0;
  for (const auto& edges : edges_at_corner)
    largest_product = std::max(largest_product, length[edges[0]] * length[edges[1]] * length[edges[2]]);
  if (largest_product > 0) shape.scaled_jacobian = std::numbers::sqrt2 * six_volumes / largest_product;

  // Circumscribed centre relative to corner 0.
  const Vec3 numerator = corner[1].squaredNorm() * corner[2].cross(corner[3]) +
                         corner[2].squaredNorm() * corner[3].cross(corner[1]) +
                         corner[3].squaredNorm() * corner[1].cross(corner[2]);
  const double radius = numerator.norm() / (2 * std::abs(six_volumes));
  if (std::isfinite(radius / *shortest)) {
    shape.edge_ratio = *longest / *shortest;
    shape.radius_edge_ratio = radius / *shortest;
  }
  return shape;
}

double curved_scaled_jacobian(const CurvedTetrahedron& x) {
  const std::array<double, 6> length = curve_lengths(x);
  double largest_product = 0;
  for (const auto& edges : edges_at_corner)
    largest_product = std::max(largest_product, length[edges[0]] * length[edges[1]] * length[edges[2]]);
  constexpr double tolerance = 0.01;  // of the largest Jacobian: a hundredth of a figure that is 1 at best
  const double least = min_jacobian_bound(x, tolerance, JacobianWanted::value).lower;
  return largest_product > 0 ? std::numbers::sqrt2 * least / largest_product : 0;
}

TetShape measure_tetrahedron(const TetMesh& mesh, std::size_t tetrahedron) {
  const CurvedTetrahedron x = curved_tetrahedron(mesh, tetrahedron);
  return mesh.order() == 1 || is_straight(x) ? measure_tetrahedron(x[0], x[1], x[2], x[3]) : measure_curved(x);
}

FaceAngles measure_face_angles(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const std::array<Vec3, 4> corner{a, b, c, d};
  FaceAngles angles{180, 0};
  for (std::size_t apex = 0; apex < 4; ++apex) {
    const std::size_t other[3] = {(apex + 1) % 4, (apex + 2) % 4, (apex + 3) % 4};
    for (std::size_t k = 0; k < 3; ++k) {
      const double angle = angle_deg(corner[apex], corner[other[k]], corner[other[(k + 1) % 3]]);
      angles.min_deg = std::min(angles.min_deg, angle);
      angles.max_deg = std::max(angles.max_deg, angle);
    }
  }
  return angles;
}

TetSummary measure_tetrahedra(const TetMesh& mesh) {
  TetSummary summary;
  summary.nodes = mesh.nodes.size();
  summary.tetrahedra = mesh.tetrahedra.size();
  summary.order = mesh.order();
  if (mesh.tetrahedra.empty()) return summary;
  summary.volume = total_volume(mesh);

  // Fixed blocks, joined in their order, so that sums round the same for any number of threads.
  constexpr std::size_t block_size = 1024;
  std::vector<Extremes> blocks((mesh.tetrahedra.size() + block_size - 1) / block_size);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
    blocks[block] = measure_range(mesh, block * block_size, std::min(mesh.tetrahedra.size(), (block + 1) * block_size));
  });
  summary.min_dihedral_deg = 180;
  summary.min_face_angle_deg = 180;
  summary.scaled_jacobian.min = 1;
  for (const Extremes& block : blocks) {
    summary.min_dihedral_deg = std::min(summary.min_dihedral_deg, block.min_dihedral_deg);
    summary.max_dihedral_deg = std::max(summary.max_dihedral_deg, block.max_dihedral_deg);
    summary.min_face_angle_deg = std::min(summary.min_face_angle_deg, block.min_face_angle_deg);
    summary.max_face_angle_deg = std::max(summary.max_face_angle_deg, block.max_face_angle_deg);
    summary.scaled_jacobian.min = std::min(summary.scaled_jacobian.min, block.min_jacobian);
    summary.scaled_jacobian.mean += block.sum_jacobian;
    summary.edge_ratio = std::max(summary.edge_ratio, block.edge_ratio);
    summary.radius_edge_ratio = std::max(summary.radius_edge_ratio, block.radius_edge_ratio);
    summary.inverted += block.inverted;
  }
  summary.scaled_jacobian.mean /= static_cast<double>(summary.tetrahedra);
  return summary;
}

}  // namespace scan2fea
