#include "preproc/symmetry/mirror_plane.hpp"

#include "preproc/mesh/median.hpp"
#include "preproc/surface/features/scan_noise.hpp"
#include "preproc/surface/kernel/adjacency.hpp"
#include "quality/triangle_tree.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace scan2fea {
namespace {

constexpr std::size_t asked_of_a_trial = 400, asked_of_a_fit = 4000;

// Points of the surface, and the area that each stands for.
struct SurfacePoints {
  std::vector<Vec3> points;
  std::vector<double> weights;
};

struct Moments {
  Vec3 centre = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // about the centre, over the area
};

// Exact for triangles.
Moments moments_of(const SurfaceMesh& mesh) {
  Moments m;
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const double a = area_vector(mesh, t).norm() / 2;
    area += a;
    m.centre += a * centroid(mesh, t);
  }
  m.centre /= area;
  for (const Triangle& t : mesh.triangles) {
    const double a = area_vector(mesh, t).norm() / 2;
    Vec3 sum = Vec3::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const std::uint32_t v : t) {
      const Vec3 d = mesh.vertices[v] - m.centre;
      sum += d;
      squares += d * d.transpose();
    }
    m.second += a / area * (squares + sum * sum.transpose()) / 12;
  }
  return m;
}

class Mirror {
 public:
  explicit Mirror(const SurfaceMesh& scan) : scan_(scan), tree_(scan), moments_(moments_of(scan)) {
    diagonal_ = bounding_box(scan.vertices).diagonal();
    for (const Triangle& t : scan.triangles) {
      all_.points.push_back(centroid(scan, t));
      all_.weights.push_back(area_vector(scan, t).norm() / 2);
    }
  }

  const Moments& moments() const { return moments_; }

  MirrorPlane plane_across(const Vec3& normal) const {
    MirrorPlane plane;
    plane.normal = normal.normalized();
    plane.offset = plane.normal.dot(moments_.centre);
    return plane;
  }

  // The root mean square distance of some reflected points.
  double rms(const MirrorPlane& plane, std::size_t asked) const {
    double squares = 0, weights = 0;
    for_some(asked, [&](const Vec3& p, double weight) {
      squares += weight * tree_.closest(reflected(plane, p)).squared_distance;
      weights += weight;
    });
    return std::sqrt(squares / weights);
  }

  void fit(MirrorPlane& plane) const {
    constexpr int most_steps = 20;
    double before = rms(plane, asked_of_a_fit);
    for (int step = 0; step < most_steps; ++step) {
      const MirrorPlane next = stepped(plane);
      const double after = rms(next, asked_of_a_fit);
      if (!(after < before)) return;
      plane = next;
      if (after > before * (1 - 1e-6)) return;
      before = after;
    }
  }

  // Coordinates of CAD are exact, and a fit is not: an axis, and a place in the middle of the box or at zero, that is
  // as good as what was fitted is what was meant.
  void round_to_axes(MirrorPlane& plane) const {
    constexpr double as_good = 1.01, rounding_of_diagonal = 1e-9, near_of_diagonal = 1e-3;
    int axis = 0;
    plane.normal.cwiseAbs().maxCoeff(&axis);
    if (plane.normal[axis] < 0) {
      plane.normal = -plane.normal;
      plane.offset = -plane.offset;
    }
    const double limit = as_good * rms(plane, asked_of_a_fit) + rounding_of_diagonal * diagonal_;
    MirrorPlane straight = plane_across(Vec3::Unit(axis));
    if ((straight.normal - plane.normal).norm() > near_of_diagonal) return;
    const BoundingBox box = bounding_box(scan_.vertices);
    for (const double offset : {0.0, (box.low[axis] + box.high[axis]) / 2, straight.offset}) {
      straight.offset = offset;
      if (std::abs(offset - moments_.centre[axis]) > near_of_diagonal * diagonal_) continue;
      if (rms(straight, asked_of_a_fit) > limit) continue;
      plane = straight;
      return;
    }
  }

  void measure(MirrorPlane& plane) const {
    double squares = 0, weights = 0, farthest = 0;
    const auto ask = [&](const Vec3& p, double weight) {
      const double d = tree_.closest(reflected(plane, p)).squared_distance;
      squares += weight * d;
      weights += weight;
      if (d <= farthest) return;
      farthest = d;
      plane.farthest = p;
    };
    for (std::size_t i = 0; i < all_.points.size(); ++i) ask(all_.points[i], all_.weights[i]);
    for (const Vec3& p : scan_.vertices) ask(p, 0);
    plane.rms_distance = std::sqrt(squares / weights);
    plane.largest_distance = std::sqrt(farthest);
  }

 private:
  static Vec3 reflected(const MirrorPlane& plane, const Vec3& p) {
    return p - 2 * (plane.normal.dot(p) - plane.offset) * plane.normal;
  }

  template <class Ask>
  void for_some(std::size_t asked, const Ask& ask) const {
    const std::size_t stride = 1 + all_.points.size() / asked;
    for (std::size_t i = 0; i < all_.points.size(); i += stride) ask(all_.points[i], all_.weights[i]);
  }

  // One Gauss-Newton step on the distances from the nearest triangles' planes; far ones, which belong to what is on one
  // side alone, weigh less (Huber's weights).
  MirrorPlane stepped(const MirrorPlane& plane) const {
    const Vec3 x = plane.normal.unitOrthogonal(), y = plane.normal.cross(x);
    struct Row {
      Vec3 by;  // the two turns and the shift
      double distance, weight;
    };
    std::vector<Row> rows;
    std::vector<double> absolute;
    for_some(asked_of_a_fit, [&](const Vec3& p, double weight) {
      const Vec3 image = reflected(plane, p);
      const ClosestPoint to = tree_.closest(image);
      const Vec3 m = area_vector(scan_, scan_.triangles[to.triangle]).normalized();
      const double height = plane.normal.dot(p) - plane.offset;
      const auto by_turn = [&](const Vec3& t) {
        return -2 * ((p - moments_.centre).dot(t) * m.dot(plane.normal) + height * m.dot(t));
      };
      rows.push_back({{by_turn(x), by_turn(y), 2 * m.dot(plane.normal)}, m.dot(image - to.point), weight});
      absolute.push_back(std::abs(rows.back().distance));
    });
    const double limit = 3 * median(std::move(absolute)) + 1e-12 * diagonal_;
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Vec3 right = Vec3::Zero();
    for (const Row& row : rows) {
      const double weight = row.weight * std::min(1.0, limit / std::max(std::abs(row.distance), 1e-300));
      matrix += weight * row.by * row.by.transpose();
      right -= weight * row.distance * row.by;
    }
    matrix.diagonal() *= 1 + 1e-9;
    matrix.diagonal().array() += 1e-12 * matrix.trace() + 1e-300;
    const Vec3 step = matrix.ldlt().solve(right);
    MirrorPlane next = plane;
    next.normal = (plane.normal + step[0] * x + step[1] * y).normalized();
    // Turned about the centre, then shifted.
    next.offset = next.normal.dot(moments_.centre) + (plane.offset - plane.normal.dot(moments_.centre)) + step[2];
    return next;
  }

  const SurfaceMesh& scan_;
  TriangleTree tree_;
  Moments moments_;
  SurfacePoints all_;
  double diagonal_ = 0;
};

// Normals that a mirror plane may have: principal axes, and where two second moments are alike all directions between
// their axes, a degree apart; across an axis of the user's, that one alone.
std::vector<Vec3> likely_normals(const Moments& moments, std::optional<int> axis) {
  if (axis) return {Vec3::Unit(*axis)};
  constexpr double alike = 0.98;
  constexpr int directions = 180;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.second);
  std::vector<Vec3> normals{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  for (int k = 0; k < 3; ++k) normals.emplace_back(solver.eigenvectors().col(k));
  for (int k = 0; k < 2; ++k) {
    if (solver.eigenvalues()[k] < alike * solver.eigenvalues()[k + 1]) continue;
    for (int i = 0; i < directions; ++i) {
      const double angle = std::numbers::pi * i / directions;
      normals.emplace_back(std::cos(angle) * solver.eigenvectors().col(k) +
                           std::sin(angle) * solver.eigenvectors().col(k + 1));
    }
  }
  return normals;
}

}  // namespace

MirrorLimits mirror_limits(const SurfaceMesh& scan) {
  constexpr double facets_of_diagonal = 0.0005, aim_of_diagonal = 0.002;
  const double diagonal = bounding_box(scan.vertices).diagonal();
  const double noise = estimate_noise(scan, MeshAdjacency(scan));
  return {2 * noise + facets_of_diagonal * diagonal, 6 * noise + aim_of_diagonal * diagonal};
}

MirrorPlane find_mirror_plane(const SurfaceMesh& scan, std::optional<int> axis, const Progress& progress) {
  constexpr std::size_t most_fitted = 5;
  const Mirror mirror(scan);
  std::vector<std::pair<double, MirrorPlane>> tried;
  for (const Vec3& normal : likely_normals(mirror.moments(), axis)) {
    progress("symmetry", 0.5);
    const MirrorPlane plane = mirror.plane_across(normal);
    tried.emplace_back(mirror.rms(plane, asked_of_a_trial), plane);
  }
  const auto nearer = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::ranges::stable_sort(tried, nearer);
  tried.resize(std::min(tried.size(), most_fitted));
  for (auto& [rms, plane] : tried) {
    progress("symmetry", 0.8);
    mirror.fit(plane);
    mirror.round_to_axes(plane);
    rms = mirror.rms(plane, asked_of_a_fit);
  }
  MirrorPlane best = std::ranges::min_element(tried, nearer)->second;
  mirror.measure(best);
  return best;
}

}  // namespace scan2fea
