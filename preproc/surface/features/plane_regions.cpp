#include "preproc/surface/features/plane_regions.hpp"

#include "preproc/mesh/face_neighbours.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

constexpr double coordinate_rounding = 1e-7;  // of the diagonal

// Of Gaussian noise one vertex of 16,000 is farther.
constexpr double vertex_of_noise = 4;
// The noise is known within 20 %, and what bends by less than this is told from a plane by nobody.
constexpr double rms_of_noise = 1.5, bend_of_noise = 0.5;

// A first plane is fitted to triangles that reach so far over the noise: by then it turns little any more.
constexpr double reach_over_noise = 20;
// By normals of noisy triangles: what stands up from the plane is another face.
constexpr double least_slope_of_side = 0.2;
constexpr double crease = 0.87;  // cosine, 30 degrees

// Moments of points about a place near them.
class Moments {
 public:
  explicit Moments(const Vec3& about) : about_(about) {}

  void add(const Vec3& p) {
    const Vec3 d = p - about_;
    sum_ += d;
    outer_ += d * d.transpose();
    ++count_;
  }

  // Through at least three points, along `side`.
  Plane plane(const Vec3& side) const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance());
    Vec3 normal = axes.eigenvectors().col(0);
    if (normal.dot(side) < 0) normal = -normal;
    return {about_ + mean(), normal};
  }

  // Across the narrower direction in the plane, mean square.
  double squared_width() const {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance(), Eigen::EigenvaluesOnly).eigenvalues()[1];
  }

  std::size_t count() const { return count_; }

 private:
  Vec3 mean() const { return sum_ / static_cast<double>(count_); }
  Eigen::Matrix3d covariance() const { return outer_ / static_cast<double>(count_) - mean() * mean().transpose(); }

  Vec3 about_, sum_ = Vec3::Zero();
  Eigen::Matrix3d outer_ = Eigen::Matrix3d::Zero();
  std::size_t count_ = 0;
};

// Of points over a plane, mean squares: how far they are from it, and what a paraboloid over it takes off that.
struct Bend {
  double from_plane = 0, bent = 0;
};

Bend bend_of(const Plane& plane, std::span<const Vec3> points) {
  const Vec3 u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
  double extent = 0;
  for (const Vec3& p : points) extent = std::max(extent, (p - plane.point).norm());
  if (!(extent > 0)) return {};
  using Row = Eigen::Matrix<double, 6, 1>;
  Eigen::Matrix<double, 6, 6> normal_matrix = Eigen::Matrix<double, 6, 6>::Zero();
  Row right = Row::Zero();
  double squares = 0;
  for (const Vec3& p : points) {
    const Vec3 d = (p - plane.point) / extent;
    const double x = d.dot(u), y = d.dot(v), z = plane.height(p);
    const Row row{1, x, y, x * x, x * y, y * y};
    normal_matrix += row * row.transpose();
    right += z * row;
    squares += z * z;
  }
  const double n = static_cast<double>(points.size());
  const Row solution = normal_matrix.completeOrthogonalDecomposition().solve(right);
  return {squares / n, std::min(squares, right.dot(solution)) / n};
}

Moments moments_about(const std::vector<Vec3>& points) {
  Moments moments(points[0]);
  for (const Vec3& p : points) moments.add(p);
  return moments;
}

// Through most of the points, near `start`: a few that a rounding's border left a little off it do not tilt it.
Plane plane_through(const std::vector<Vec3>& points, const Plane& start) {
  constexpr int rounds = 2;
  constexpr double of_median = 3, rounding = 1e-14;
  Plane plane = moments_about(points).plane(start.normal);
  for (int round = 0; round < rounds; ++round) {
    std::vector<double> heights;
    double extent = 0;
    for (const Vec3& p : points) {
      heights.push_back(std::abs(plane.height(p)));
      extent = std::max(extent, (p - plane.point).norm());
    }
    std::ranges::nth_element(heights, heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2));
    const double farthest = of_median * heights[heights.size() / 2] + rounding * extent;
    std::vector<Vec3> near;
    std::ranges::copy_if(points, std::back_inserter(near),
                         [&](const Vec3& p) { return std::abs(plane.height(p)) <= farthest; });
    if (near.size() < 3) break;
    plane = moments_about(near).plane(plane.normal);
  }
  return plane;
}

class Regions {
 public:
  Regions(const SurfaceMesh& scan, double noise, double edge)
      : scan_(scan),
        stars_(scan),
        neighbours_(face_neighbours(scan, stars_)),
        noise_(std::max(noise, coordinate_rounding * bounding_box(scan.vertices).diagonal() / vertex_of_noise)),
        is_exact_(noise_ > noise),
        edge_(edge),
        triangle_mark_(scan.triangles.size(), 0),
        vertex_mark_(scan.vertices.size(), 0) {
    result_.of_triangle.assign(scan.triangles.size(), no_plane);
    result_.tolerance = vertex_of_noise * noise_;
  }

  PlaneRegions run() {
    const std::vector<Index> seeds = this->seeds();
    constexpr std::size_t enough_tries = 2000;
    std::size_t tried = 0;
    for (const Index seed : seeds) {
      if (result_.of_triangle[seed] != no_plane || was_tried(seed)) continue;
      if (tried++ == enough_tries && result_.list.empty()) break;
      grow_from(seed);
    }
    if (result_.list.empty()) result_.of_triangle.clear();
    return std::move(result_);
  }

 private:
  // The largest first where triangles differ; spread over the scan, and no more than a region of one result's triangle
  // needs to be met.
  std::vector<Index> seeds() const {
    constexpr double tries_a_face = 4;
    double area = 0;
    for (const Triangle& t : scan_.triangles) area += area_vector(scan_, t).norm() / 2;
    const double faces = area / (edge_ * edge_);
    const auto count = static_cast<double>(scan_.triangles.size());
    const double step = std::max(1.0, count / std::max(tries_a_face * faces, 2000.0));
    std::vector<Index> seeds;
    // In the order of a sequence that spreads (golden ratio), so that the first ones are everywhere.
    constexpr double golden = 0.6180339887498949;
    const auto wanted = static_cast<std::size_t>(count / step);
    std::vector<bool> has(scan_.triangles.size(), false);
    double place = 0;
    for (std::size_t i = 0; i < wanted; ++i) {
      place += golden;
      place -= std::floor(place);
      const auto seed = static_cast<std::size_t>(place * count);
      if (seed >= has.size() || has[seed]) continue;
      has[seed] = true;
      seeds.push_back(static_cast<Index>(seed));
    }
    for (Index f = 0; step == 1 && f < has.size(); ++f)
      if (!has[f]) seeds.push_back(f);
    const double mean = area / count;
    std::ranges::stable_partition(seeds,
                                  [&](Index f) { return area_vector(scan_, scan_.triangles[f]).norm() > 8 * mean; });
    return seeds;
  }

  bool was_tried(Index f) const { return !tried_.empty() && tried_[f]; }

  void grow_from(Index seed) {
    const Vec3 side = area_vector(scan_, scan_.triangles[seed]);
    if (!(side.norm() > 0)) return;
    std::vector<Index> region = first_patch(seed);
    Plane plane = moments_of(region).plane(side);
    if (!is_near(plane, region)) return;
    grow(seed, plane, region, true);
    constexpr int rounds = 3;
    std::vector<Vec3> inner;
    for (int round = 0; round < rounds; ++round) {
      inner = inner_points(region, plane);
      if (inner.size() < 3) return;
      plane = plane_through(inner, plane);
      if (!is_near(plane, {&seed, 1})) return;
      grow(seed, plane, region, false);
    }
    if (tried_.empty()) tried_.resize(scan_.triangles.size(), false);
    for (const Index f : region) tried_[f] = true;
    if (!is_plane(plane, region, inner) || !is_face(region)) return;
    const auto number = static_cast<Index>(result_.list.size());
    for (const Index f : region) result_.of_triangle[f] = number;
    fill_pits(region, number, plane);
    result_.list.push_back(plane);
  }

  // Around the seed as far as noise does not tilt the plane through it.
  std::vector<Index> first_patch(Index seed) {
    ++mark_;
    const double reach = is_exact_ ? 0 : reach_over_noise * noise_;
    const Vec3 centre = centroid(scan_, scan_.triangles[seed]);
    std::vector<Index> patch{seed};
    triangle_mark_[seed] = mark_;
    for (std::size_t i = 0; i < patch.size(); ++i)
      for (const Index g : neighbours_[patch[i]]) {
        if (g == no_face || triangle_mark_[g] == mark_) continue;
        triangle_mark_[g] = mark_;
        if ((centroid(scan_, scan_.triangles[g]) - centre).norm() < reach) patch.push_back(g);
      }
    return patch;
  }

  Moments moments_of(std::span<const Index> triangles) {
    ++mark_;
    Moments moments(scan_.vertices[scan_.triangles[triangles[0]][0]]);
    for (const Index f : triangles) add_points(f, moments);
    return moments;
  }

  // Those that have not been added since the mark rose.
  void add_points(Index f, Moments& moments) {
    for (const Index v : scan_.triangles[f])
      if (vertex_mark_[v] != mark_) {
        vertex_mark_[v] = mark_;
        moments.add(scan_.vertices[v]);
      }
  }

  bool is_near(const Plane& plane, std::span<const Index> triangles) const {
    return std::ranges::all_of(triangles, [&](Index f) { return fits(plane, f); });
  }

  bool fits(const Plane& plane, Index f) const {
    for (const Index v : scan_.triangles[f])
      if (std::abs(plane.height(scan_.vertices[v])) > result_.tolerance) return false;
    const Vec3 side = area_vector(scan_, scan_.triangles[f]);
    return side.dot(plane.normal) >= least_slope_of_side * side.norm();
  }

  // What hangs together with the seed near the plane, which follows as the region grows.
  void grow(Index seed, Plane& plane, std::vector<Index>& region, bool follows) {
    constexpr double between_fits = 1.5;
    ++mark_;
    region.assign(1, seed);
    triangle_mark_[seed] = mark_;
    Moments moments(scan_.vertices[scan_.triangles[seed][0]]);
    add_points(seed, moments);
    std::size_t next_fit = 12;
    for (std::size_t i = 0; i < region.size(); ++i)
      for (const Index g : neighbours_[region[i]]) {
        if (g == no_face || triangle_mark_[g] == mark_ || result_.of_triangle[g] != no_plane || !fits(plane, g))
          continue;
        triangle_mark_[g] = mark_;
        region.push_back(g);
        if (!follows || is_exact_) continue;
        add_points(g, moments);
        if (moments.count() < next_fit) continue;
        plane = moments.plane(plane.normal);
        next_fit = static_cast<std::size_t>(between_fits * static_cast<double>(moments.count()));
      }
  }

  // Points of the region away from where it may run on into a rounding, which is no border at a crease; none where
  // these are fewer than half.
  std::vector<Vec3> inner_points(std::span<const Index> region, const Plane& plane) {
    constexpr int rings = 2;
    constexpr double enough = 0.5;
    const Index stripped = ++mark_, inside = ++mark_;
    for (const Index f : region) triangle_mark_[f] = inside;
    std::vector<Index> inner;
    for (const Index f : region)
      for (const Index v : scan_.triangles[f])
        if (vertex_mark_[v] != inside) {
          vertex_mark_[v] = inside;
          inner.push_back(v);
        }
    const double fewest = enough * static_cast<double>(inner.size());
    const auto runs_on = [&](Index corner) {
      const Index f = corner / 3;
      if (triangle_mark_[f] == inside || triangle_mark_[f] == stripped) return triangle_mark_[f] == stripped;
      const Vec3 side = area_vector(scan_, scan_.triangles[f]);
      return side.dot(plane.normal) > crease * side.norm();
    };
    for (int ring = 0; ring < rings && !is_exact_; ++ring) {
      std::vector<Index> next;
      for (const Index v : inner) (std::ranges::any_of(stars_.corners(v), runs_on) ? outer_ : next).push_back(v);
      if (static_cast<double>(next.size()) < fewest) next.clear();
      inner = std::move(next);
      for (const Index v : outer_)
        for (const Index corner : stars_.corners(v))
          if (triangle_mark_[corner / 3] == inside) triangle_mark_[corner / 3] = stripped;
      outer_.clear();
    }
    std::vector<Vec3> points;
    for (const Index v : inner) points.push_back(scan_.vertices[v]);
    return points;
  }

  // By what is away from the border, which bends less than the whole does if it is narrower.
  bool is_plane(const Plane& plane, std::span<const Index> region, const std::vector<Vec3>& inner) {
    const Bend bend = bend_of(plane, inner);
    if (bend.from_plane > std::pow(rms_of_noise * noise_, 2)) return false;
    if (is_exact_) return true;
    const double wider = moments_of(region).squared_width() / moments_about(inner).squared_width();
    return std::sqrt(bend.bent) * wider <= bend_of_noise * noise_;
  }

  // Rather than a facet of something round: wide, or between creases.
  bool is_face(std::span<const Index> region) {
    ++mark_;
    for (const Index f : region) triangle_mark_[f] = mark_;
    double area = 0, border = 0, sharp = 0;
    for (const Index f : region) {
      const Triangle& t = scan_.triangles[f];
      const Vec3 side = area_vector(scan_, t);
      area += side.norm() / 2;
      for (std::size_t k = 0; k < 3; ++k) {
        const Index g = neighbours_[f][k];
        if (g != no_face && triangle_mark_[g] == mark_) continue;
        const double length = (scan_.vertices[t[(k + 1) % 3]] - scan_.vertices[t[(k + 2) % 3]]).norm();
        border += length;
        if (g == no_face) {
          sharp += length;
          continue;
        }
        const Vec3 other = area_vector(scan_, scan_.triangles[g]);
        if (other.dot(side) < crease * other.norm() * side.norm()) sharp += length;
      }
    }
    return 2 * area > edge_ * border || (is_exact_ && 2 * sharp > border);
  }

  // Around vertices that lie a little farther than the others, and alone in the region.
  void fill_pits(std::span<const Index> region, Index number, const Plane& plane) {
    constexpr double deepest = 2;
    const auto is_pit = [&](Index v) {
      return std::abs(plane.height(scan_.vertices[v])) <= deepest * result_.tolerance &&
             std::ranges::all_of(stars_.corners(v), [&](Index corner) {
               const Index across = neighbours_[corner / 3][corner % 3];
               return across != no_face && result_.of_triangle[across] == number;
             });
    };
    for (const Index f : region)
      for (const Index g : neighbours_[f]) {
        if (g == no_face || result_.of_triangle[g] != no_plane) continue;
        for (std::size_t k = 0; k < 3; ++k) {
          const Index v = scan_.triangles[g][k];
          if (neighbours_[g][k] != f || !is_pit(v)) continue;
          for (const Index corner : stars_.corners(v)) result_.of_triangle[corner / 3] = number;
        }
      }
  }

  const SurfaceMesh& scan_;
  VertexStars stars_;
  std::vector<Triangle> neighbours_;
  double noise_;
  bool is_exact_;  // up to the rounding of coordinates
  double edge_;
  PlaneRegions result_;
  std::vector<bool> tried_;
  std::vector<Index> triangle_mark_, vertex_mark_;  // of what was visited since the mark rose
  std::vector<Index> outer_;                        // of a ring
  Index mark_ = 0;
};

}  // namespace

PlaneRegions find_plane_regions(const SurfaceMesh& scan, double noise, double edge) {
  if (scan.triangles.empty()) return {};
  return Regions(scan, noise, edge).run();
}

}  // namespace scan2fea
