#include "preproc/surface/kernel/canonical_frame.hpp"

#include "preproc/surface/kernel/parallel_blocks.hpp"
#include "preproc/surface/kernel/smallest_box.hpp"
#include "preproc/surface/kernel/spatial_order.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace scan2fea {
namespace {

// The sums' own rounding is to stay below that of the coordinates.
using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;
using Matrix = Eigen::Matrix<Real, 3, 3>;

// Of the moments' sum: axes of moments that differ by less turn with the last bits of the coordinates.
constexpr Real apart = 0.01L;

// What rounding leaves different of areas and directions; and of sums over all triangles.
constexpr Real nearly = 1e-9L, nearly_of_sum = 1e-12L;

struct Moments {
  Vector centre = Vector::Zero();
  Matrix normals = Matrix::Zero();
  Real radius = 0;  // root mean square distance from the centre
};

Vector corner(const SurfaceMesh& mesh, const Triangle& t, int k) {
  return mesh.vertices[t[static_cast<std::size_t>(k)]].cast<Real>();
}

Vector doubled_area(const SurfaceMesh& mesh, const Triangle& t) {
  const Vector a = corner(mesh, t, 0);
  return (corner(mesh, t, 1) - a).cross(corner(mesh, t, 2) - a);
}

Moments moments_of(const SurfaceMesh& mesh) {
  Moments moments;
  Real area = 0, squares = 0;
  const Vector near = corner(mesh, mesh.triangles.front(), 0);
  for (const Triangle& t : mesh.triangles) {
    const Vector normal = doubled_area(mesh, t);
    const Real twice = normal.norm();
    if (!(twice > 0)) continue;
    const Vector middle = (corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2)) / 3 - near;
    area += twice;
    moments.centre += twice * middle;
    squares += twice * middle.squaredNorm();
    moments.normals += normal * normal.transpose() / twice;
  }
  moments.centre /= area;
  moments.radius = std::sqrt(std::max(squares / area - moments.centre.squaredNorm(), Real(0)));
  moments.centre += near;
  moments.normals /= area;
  return moments;
}

// The directions, across `axis`, of those of `count` vectors that reach farthest across it; of all where it is zero.
// None where all are along it.
template <class VectorAt>
std::vector<Vector> farthest_across(const Vector& axis, std::size_t count, std::size_t most,
                                    const VectorAt& vector_at) {
  const auto across = [&](std::size_t i) {
    const Vector v = vector_at(i);
    return Vector(v - v.dot(axis) * axis);
  };
  Real farthest = 0, longest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    farthest = std::max(farthest, across(i).norm());
    longest = std::max(longest, vector_at(i).norm());
  }
  std::vector<Vector> directions;
  if (farthest <= nearly * longest) return directions;
  for (std::size_t i = 0; i < count && directions.size() < most; ++i) {
    const Vector v = across(i), direction = v.normalized();
    if (v.norm() >= (1 - nearly) * farthest &&
        std::ranges::none_of(directions, [&](const Vector& d) { return (d - direction).norm() < nearly; }))
      directions.push_back(direction);
  }
  return directions;
}

// Of the largest triangles the normals or, where these are so small that the coordinates' last bits turn them, the ways
// to their middles; in a plane, which has but one normal, the longest edges.
std::vector<Vector> landmarks(const SurfaceMesh& mesh, const Moments& moments, const Vector& axis) {
  constexpr std::size_t most_work = 100000000, least = 16;  // all of most parts, of huge ones as many as cost little
  constexpr Real small = 0.04L;                             // doubled area, over the radius squared
  const std::vector<Triangle>& triangles = mesh.triangles;
  const std::size_t most = std::max(least, most_work / triangles.size());
  Real largest = 0;
  for (const Triangle& t : triangles) largest = std::max(largest, doubled_area(mesh, t).norm());
  std::vector<Vector> found = farthest_across(axis, triangles.size(), most, [&](std::size_t f) {
    const Triangle& t = triangles[f];
    const Vector normal = doubled_area(mesh, t);
    if (largest > small * moments.radius * moments.radius) return normal;
    const Vector middle = (corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2)) / 3;
    return Vector(normal.norm() * (middle - moments.centre));
  });
  if (found.empty())
    found = farthest_across(axis, 3 * triangles.size(), most, [&](std::size_t i) {
      const Triangle& t = triangles[i / 3];
      const int k = static_cast<int>(i % 3);
      return Vector(corner(mesh, t, (k + 1) % 3) - corner(mesh, t, k));
    });
  return found;
}

// A sum over the triangles' heights along a direction, with all powers: the first five of an icosahedron's are the same
// along all directions. It tells most directions apart along which the part looks otherwise.
class Asymmetry {
 public:
  Asymmetry(const SurfaceMesh& mesh, const Moments& moments) : mesh_(mesh), moments_(moments) {}

  Real along(const Vector& direction) const {
    const Vector scaled = direction / moments_.radius;
    const Real at_centre = scaled.dot(moments_.centre);
    std::vector<Real> height(mesh_.vertices.size());
    for (std::size_t v = 0; v < height.size(); ++v) height[v] = scaled.dot(mesh_.vertices[v].cast<Real>()) - at_centre;
    Real sum = 0;
    for (const Triangle& t : mesh_.triangles) {
      const Real a = height[t[0]], b = height[t[1]], c = height[t[2]], all = a + b + c;
      sum += a * b * c * (1 + all) / (4 + all * all);
    }
    return sum / static_cast<Real>(mesh_.triangles.size());
  }

  // Those along which the sum is largest: as many that agree as are enough to have one of each kind, if there are more.
  template <class Item, class Direction>
  std::vector<Item> largest(const std::vector<Item>& items, const Direction& direction) const {
    constexpr std::size_t enough = 16;
    std::vector<Item> best;
    Real sum_of_best = -std::numeric_limits<Real>::infinity();
    for (const Item& item : items) {
      const Real sum = along(direction(item));
      if (sum < sum_of_best - nearly_of_sum) continue;
      if (sum > sum_of_best + nearly_of_sum) {
        best.clear();
        sum_of_best = sum;
      }
      if (best.size() < enough) best.push_back(item);
    }
    return best;
  }

 private:
  const SurfaceMesh& mesh_;
  const Moments& moments_;
};

// Right-handed ones along these two directions.
void add_frames(const Vector& x, const Vector& y, std::vector<Matrix>& frames) {
  for (const Real sign_x : {1, -1})
    for (const Real sign_y : {1, -1}) {
      Matrix axes;
      axes << sign_x * x, sign_y * y, sign_x * sign_y * x.cross(y);
      frames.push_back(axes);
    }
}

// Several where the sums don't tell them apart.
std::vector<Matrix> possible_axes(const SurfaceMesh& mesh, const Moments& moments) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(moments.normals);
  const Vector& moment = solver.eigenvalues();
  const Matrix& axis = solver.eigenvectors();
  const bool low = moment[1] - moment[0] > apart, high = moment[2] - moment[1] > apart;
  const Asymmetry asymmetry(mesh, moments);
  std::vector<Matrix> frames;
  if (low && high) {
    add_frames(axis.col(2), axis.col(1), frames);
  } else {
    std::vector<Vector> first{axis.col(high ? 2 : 0)};
    if (!low && !high)
      first = asymmetry.largest(landmarks(mesh, moments, Vector::Zero()), [](const Vector& v) { return v; });
    for (const Vector& x : first)
      for (const Vector& y : landmarks(mesh, moments, x)) add_frames(x, y, frames);
  }
  const Vector oblique(0.48L, 0.29L, 0.83L);  // to all planes of symmetry that parts have
  return asymmetry.largest(frames, [&](const Matrix& axes) { return Vector(axes * oblique); });
}

bool is_before(const SurfaceMesh& a, const SurfaceMesh& b) {
  for (std::size_t v = 0; v < a.vertices.size(); ++v)
    if (a.vertices[v] != b.vertices[v]) return std::ranges::lexicographical_compare(a.vertices[v], b.vertices[v]);
  return a.triangles < b.triangles;
}

// Where on a circle of circumference 1 the widest gap between these places has its middle; of gaps alike the first from
// -1/4, where no symmetric set has one.
double middle_of_widest_gap(std::vector<double>& places) {
  constexpr double alike = 0.01, first = -0.25;
  for (double& p : places) p -= std::floor(p - first);
  std::ranges::sort(places);
  const auto gap = [&](std::size_t i) {
    return i + 1 < places.size() ? places[i + 1] - places[i] : places[0] + 1 - places[i];
  };
  double widest = 0;
  for (std::size_t i = 0; i < places.size(); ++i) widest = std::max(widest, gap(i));
  double middle = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (gap(i) < (1 - alike) * widest) continue;
    const double at = places[i] + gap(i) / 2;
    middle = std::min(middle, at - std::floor(at - first));
  }
  return middle;
}

// Where the grid begins along an axis, in its steps, to be clear of all vertices.
double grid_begin(const SurfaceMesh& mesh, const Vec3& axis, const Vec3& origin, double step) {
  std::vector<double> places(mesh.vertices.size());
  for (std::size_t v = 0; v < places.size(); ++v)
    places[v] = static_cast<double>(axis.cast<Real>().dot(mesh.vertices[v].cast<Real>() - origin.cast<Real>()) /
                                    static_cast<Real>(step));
  return middle_of_widest_gap(places) + 0.5;
}

}  // namespace

CanonicalFrame::CanonicalFrame(const SurfaceMesh& mesh, SurfaceMesh& placed) {
  constexpr int finest = -43, coarsest = -27;
  const Moments moments = moments_of(mesh);
  unit_ = static_cast<double>(moments.radius);
  step_ = std::ldexp(1, std::min(finest + std::ilogb(static_cast<double>(mesh.vertices.size())) + 1, coarsest));
  const std::vector<Matrix> possible = possible_axes(mesh, moments);
  const Vec3 centre = moments.centre.cast<double>();
  lie(mesh, possible.front().cast<double>(), centre);
  placed = on_grid(mesh);
  for (std::size_t i = 1; i < possible.size(); ++i) {
    CanonicalFrame other = *this;
    other.lie(mesh, possible[i].cast<double>(), centre);
    SurfaceMesh placed_otherwise = other.on_grid(mesh);
    if (!is_before(placed_otherwise, placed)) continue;
    *this = other;
    placed = std::move(placed_otherwise);
  }
  turn_ = smallest_box_axes(placed.vertices);
  for (Vec3& p : placed.vertices) p = turn_.transpose() * p;
}

void CanonicalFrame::lie(const SurfaceMesh& mesh, const Eigen::Matrix3d& axes, const Vec3& centre) {
  // Above this there is no place for the grid that is clear of all vertices.
  constexpr std::size_t most_to_clear = 1U << 18U;
  axes_ = axes;
  origin_ = centre;
  if (mesh.vertices.size() > most_to_clear) return;
  Vec3 begin;
  for (int k = 0; k < 3; ++k) begin[k] = grid_begin(mesh, axes_.col(k), origin_, unit_ * step_);
  origin_ += axes_ * (begin * (unit_ * step_));
}

SurfaceMesh CanonicalFrame::on_grid(const SurfaceMesh& mesh) const {
  SurfaceMesh placed{std::vector<Vec3>(mesh.vertices.size()), mesh.triangles};
  for_each_block(mesh.vertices.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) placed.vertices[v] = on_grid(mesh.vertices[v]);
  });
  order_along_curve(placed);
  return placed;
}

Vec3 CanonicalFrame::on_grid(const Vec3& p) const {
  const Vector at = axes_.transpose().cast<Real>() * (p.cast<Real>() - origin_.cast<Real>()) /
                    (static_cast<Real>(unit_) * static_cast<Real>(step_));
  return at.cast<double>().array().round() * step_;
}

Vec3 CanonicalFrame::to_frame(const Vec3& p) const {
  return turn_.transpose() * on_grid(p);
}

Vec3 CanonicalFrame::place_of(const Vec3& p) const {
  const double step = 4 * unit_ * step_;  // a half of the grid's along each of three axes, and more
  return (back(p) / step).array().round() * step;
}

void CanonicalFrame::bring_back(std::vector<Vec3>& points, const SurfaceMesh& mesh) const {
  if (points.empty()) return;
  const double step = unit_ * step_;
  std::array<std::vector<double>, 3> own;
  tbb::parallel_for(std::size_t{0}, own.size(), [&](std::size_t axis) {
    for (const Vec3& p : mesh.vertices) own[axis].push_back(p[static_cast<Eigen::Index>(axis)]);
    std::ranges::sort(own[axis]);
  });
  for_each_block(points.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) {
      Vec3& p = points[v];
      p = back(p);
      for (std::size_t axis = 0; axis < own.size(); ++axis) {
        double& x = p[static_cast<Eigen::Index>(axis)];
        const auto near = std::ranges::lower_bound(own[axis], x - step);
        if (near != own[axis].end() && *near <= x + step) x = *near;
      }
    }
  });
}

}  // namespace scan2fea
