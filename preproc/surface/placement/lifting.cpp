#include "preproc/surface/placement/lifting.hpp"

#include "preproc/mesh/names.hpp"
#include "preproc/surface/kernel/tangent_frame.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <cmath>
#include <vector>

namespace scan2fea {
namespace {

// Cosine of 75 degrees.
constexpr double smallest_normal_cosine = 0.26;

constexpr NameTable<Lifting, 5> lifting_names{{
    {Lifting::triharmonic, "triharmonic"},
    {Lifting::moving_least_squares, "mls"},
    {Lifting::modified_quadratic_shepard, "quadratic-shepard"},
    {Lifting::hermite, "hermite"},
    {Lifting::shepard, "shepard"},
}};

// A sample seen in the tangent plane at the base. Lengths are over the radius, so that the equations are well scaled.
struct Height {
  double u, v, z;    // in the frame of the base
  double zu, zv;     // slopes, from the normal
  double distance2;  // u^2 + v^2
};

std::vector<Height> heights_over_plane(std::span<const SurfaceSample> samples, const Vec3& base, const Vec3& normal,
                                       double radius, double smallest_cosine) {
  const TangentFrame frame(normal);
  std::vector<Height> heights;
  heights.reserve(samples.size());
  for (const SurfaceSample& sample : samples) {
    const Vec3 d = (sample.point - base) / radius;
    const double cosine = sample.normal.dot(normal);
    const double x = d.dot(frame.x), y = d.dot(frame.y);
    if (x * x + y * y >= 1 || cosine < smallest_cosine) continue;
    heights.push_back({x, y, d.dot(normal), -sample.normal.dot(frame.x) / cosine, -sample.normal.dot(frame.y) / cosine,
                       x * x + y * y});
  }
  return heights;
}

// Wendland's weight made to interpolate: infinite at the sample, but for the 1e-10 that spares a division by zero. A
// sample nearer than a hundred-thousandth of the radius counts as met.
double interpolating_weight(double distance2) {
  return wendland(std::sqrt(distance2)) / (distance2 + 1e-10);
}

double shepard(const std::vector<Height>& heights) {
  double sum = 0, weights = 0;
  for (const Height& h : heights) {
    const double w = wendland(std::sqrt(h.distance2));
    sum += w * h.z;
    weights += w;
  }
  return weights > 0 ? sum / weights : 0;
}

// Weighted least squares by the normal equations. The last three unknowns are the coefficients of u^2, u v and v^2;
// they are drawn to zero where the rows leave them open, by the quadric's bending energy, which does not depend on the
// axes.
template <int unknowns>
class LeastSquares {
 public:
  using Row = Eigen::Matrix<double, unknowns, 1>;

  void add(double weight, const Row& row, double value) {
    matrix_.template selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    right_ += weight * value * row;
    total_ += weight;
  }

  // The first term keeps the factorisation from dividing by zero where samples lie in a line or are too few, and is far
  // below any sample's weight. The second is the bending energy, 4 d^2 + 2 e^2 + 4 f^2 for d u^2 + e u v + f v^2, which
  // gives the weights 1, 1/2 and 1: a hundred-thousandth of the samples' weight settles what they leave open without
  // a trace where they do not.
  Row solve() {
    matrix_.diagonal().array() += 1e-12 * total_;
    matrix_.diagonal().template tail<3>() += 1e-5 * total_ * Vec3(1, 0.5, 1);
    return matrix_.template selfadjointView<Eigen::Lower>().ldlt().solve(right_);
  }

 private:
  Eigen::Matrix<double, unknowns, unknowns> matrix_ = Eigen::Matrix<double, unknowns, unknowns>::Zero();
  Row right_ = Row::Zero();
  double total_ = 0;
};

// The height at the base of a quadric a + b u + c v + d u^2 + e u v + f v^2.
double moving_least_squares(const std::vector<Height>& heights, bool with_normals) {
  // Slopes weigh as heights at this distance, over the radius, would.
  constexpr double slope_length = 0.3;
  LeastSquares<6> system;
  using Row = LeastSquares<6>::Row;
  for (const Height& h : heights) {
    const double w = interpolating_weight(h.distance2);
    system.add(w, Row(1, h.u, h.v, h.u * h.u, h.u * h.v, h.v * h.v), h.z);
    if (!with_normals) continue;
    // Without the pole: normals are estimates and not to be met exactly. 0.04 is the square of a fifth of the radius:
    // nearer samples than that tell the slope alike.
    const double ws = slope_length * slope_length * wendland(std::sqrt(h.distance2)) / (h.distance2 + 0.04);
    system.add(ws, Row(0, 1, 0, 2 * h.u, h.v, 0), h.zu);
    system.add(ws, Row(0, 0, 1, 0, h.u, 2 * h.v), h.zv);
  }
  return heights.empty() ? 0 : system.solve()[0];
}

// The height at the base of the quadric through sample i that fits the others best.
double quadric_through(const std::vector<Height>& heights, std::size_t i) {
  LeastSquares<5> system;
  using Row = LeastSquares<5>::Row;
  const Height& centre = heights[i];
  for (std::size_t j = 0; j < heights.size(); ++j) {
    if (j == i) continue;
    const double u = heights[j].u - centre.u, v = heights[j].v - centre.v;
    // Samples lie within 1 of the base, hence within 2 of one another.
    const double w = interpolating_weight(0.25 * (u * u + v * v));
    system.add(w, Row(u, v, u * u, u * v, v * v), heights[j].z - centre.z);
  }
  const double u = -centre.u, v = -centre.v;
  return centre.z + Row(u, v, u * u, u * v, v * v).dot(system.solve());
}

double modified_quadratic_shepard(const std::vector<Height>& heights) {
  if (heights.size() == 1) return heights[0].z;
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double w = interpolating_weight(heights[i].distance2);
    sum += w * quadric_through(heights, i);
    weights += w;
  }
  return weights > 0 ? sum / weights : 0;
}

}  // namespace

std::string_view name_of(Lifting lifting) {
  return name_in(lifting_names, lifting);
}

double wendland(double r) {
  if (r >= 1) return 0;
  const double s = (1 - r) * (1 - r);
  return s * s * (4 * r + 1);
}

double lifted_height(Lifting lifting, std::span<const SurfaceSample> samples, const Vec3& base, const Vec3& normal,
                     double radius) {
  const double cosine = lifting == Lifting::shepard ? -2 : smallest_normal_cosine;
  const std::vector<Height> heights = heights_over_plane(samples, base, normal, radius, cosine);
  switch (lifting) {
    case Lifting::triharmonic:
      return 0;
    case Lifting::shepard:
      return radius * shepard(heights);
    case Lifting::modified_quadratic_shepard:
      return radius * modified_quadratic_shepard(heights);
    case Lifting::moving_least_squares:
      return radius * moving_least_squares(heights, false);
    case Lifting::hermite:
      return radius * moving_least_squares(heights, true);
  }
  return 0;
}

}  // namespace scan2fea
