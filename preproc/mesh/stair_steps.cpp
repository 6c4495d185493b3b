#include "preproc/mesh/stair_steps.hpp"

#include "preproc/mesh/face_neighbours.hpp"
#include "preproc/mesh/median.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace scan2fea {
namespace {

// What 32-bit floats leave of directions and of lengths, with room for voxels some thousands of their size from the
// origin.
constexpr double tilt = 2e-3, of_length = 0.01;

// Of the faces, or of the lengths, that must be as the kind demands.
constexpr double nearly_all = 0.9;

// The share of faces on stairs: a plane that leans by one step in twenty has so many.
constexpr double least_stairs = 0.05;

// Across the part: it may be meant to have fewer equal ones.
constexpr std::size_t fewest_steps = 10;

// Faces that are tried for the direction of an axis, evenly among all.
constexpr std::size_t tried_faces = 16;

bool is_along(const Vec3& a, const Vec3& b) {
  return a.cross(b).norm() < tilt;
}

bool is_across(const Vec3& a, const Vec3& b) {
  return std::abs(a.dot(b)) < tilt;
}

// Nothing where the values are not nearly all the same.
std::optional<double> common_value(std::vector<double> values) {
  if (values.empty()) return {};
  const double common = median(values);
  const auto alike = std::ranges::count_if(values, [&](double x) { return std::abs(x - common) < of_length * common; });
  if (static_cast<double>(alike) < nearly_all * static_cast<double>(values.size())) return {};
  return common;
}

class StairFinder {
 public:
  explicit StairFinder(const SurfaceMesh& mesh) : mesh_(mesh), normals_(mesh.triangles.size(), Vec3::Zero()) {
    for (std::size_t f = 0; f < normals_.size(); ++f)
      if (const Vec3 area = area_vector(mesh, mesh.triangles[f]); !area.isZero()) normals_[f] = area.normalized();
  }

  std::optional<StairSteps> find() {
    const std::size_t stride = normals_.size() / tried_faces + 1;
    for (std::size_t f = 0; f < normals_.size(); f += stride) {
      const Vec3& axis = normals_[f];
      if (axis.isZero() ||
          !holds_for_nearly_all([&](const Vec3& n) { return is_along(n, axis) || is_across(n, axis); }))
        continue;
      if (auto voxels = voxels_along(axis)) return voxels;
      if (auto slices = slices_across(axis)) return slices;
    }
    return {};
  }

 private:
  template <class Condition>
  bool holds_for_nearly_all(const Condition& condition) const {
    auto others = static_cast<std::size_t>((1 - nearly_all) * static_cast<double>(normals_.size()));
    for (const Vec3& n : normals_)
      if (!condition(n) && others-- == 0) return false;
    return true;
  }

  std::optional<StairSteps> voxels_along(const Vec3& first) {
    const auto other =
        std::ranges::find_if(normals_, [&](const Vec3& n) { return !n.isZero() && is_across(n, first); });
    if (other == normals_.end()) return {};
    const std::array<Vec3, 3> axes{first, *other, first.cross(*other)};
    const auto is_on_axis = [&](const Vec3& n) {
      return std::ranges::any_of(axes, [&](const Vec3& a) { return is_along(n, a); });
    };
    if (!holds_for_nearly_all(is_on_axis)) return {};
    StairSteps steps{.kind = StairSteps::Kind::voxels};
    std::size_t long_axes = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto size = common_value(lengths_along(axes[k]));
      if (!size) return {};
      steps.size[k] = *size;
      long_axes += extent_of_all(axes[k]) > (fewest_steps - of_length) * *size;
    }
    if (long_axes < 2) return {};
    std::size_t on_stairs = 0;
    for (std::uint32_t f = 0; f < normals_.size(); ++f)
      on_stairs += is_on_axis(normals_[f]) && (is_step(f, axes[0]) || is_step(f, axes[1]) || is_step(f, axes[2]));
    if (!is_enough(on_stairs)) return {};
    std::ranges::sort(steps.size);
    return steps;
  }

  std::optional<StairSteps> slices_across(const Vec3& axis) {
    std::vector<double> heights, walls;
    std::size_t on_stairs = 0;
    for (std::uint32_t f = 0; f < normals_.size(); ++f) {
      if (normals_[f].isZero()) continue;
      const auto [low, high] = extent(f, axis);
      if (is_along(normals_[f], axis)) {
        heights.push_back((low + high) / 2);
      } else {
        walls.push_back(high - low);
        on_stairs += is_step(f, axis);
      }
    }
    const auto height = common_value(walls);
    if (!height || !is_enough(on_stairs) || levels(heights, *height) < fewest_steps) return {};
    return StairSteps{.kind = StairSteps::Kind::slices, .size = {*height, *height, *height}};
  }

  static std::size_t levels(std::vector<double> heights, double step) {
    std::ranges::sort(heights);
    std::size_t count = heights.empty() ? 0 : 1;
    for (std::size_t i = 1; i < heights.size(); ++i) count += heights[i] - heights[i - 1] > step / 2;
    return count;
  }

  std::vector<double> lengths_along(const Vec3& axis) const {
    std::vector<double> lengths;
    for (const Triangle& t : mesh_.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 edge = mesh_.vertices[t[(k + 1) % 3]] - mesh_.vertices[t[k]];
        if (edge.cross(axis).norm() < tilt * edge.norm()) lengths.push_back(edge.norm());
      }
    return lengths;
  }

  std::pair<double, double> extent(std::uint32_t f, const Vec3& axis) const {
    const Triangle& t = mesh_.triangles[f];
    return std::minmax(
        {axis.dot(mesh_.vertices[t[0]]), axis.dot(mesh_.vertices[t[1]]), axis.dot(mesh_.vertices[t[2]])});
  }

  double extent_of_all(const Vec3& axis) const {
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
    for (const Vec3& p : mesh_.vertices) {
      low = std::min(low, axis.dot(p));
      high = std::max(high, axis.dot(p));
    }
    return high - low;
  }

  // A face that reaches from an edge that is convex to one that is concave: one side of it ends at a higher, the other
  // at a lower step.
  bool is_step(std::uint32_t f, const Vec3& axis) {
    mark_corners();
    const auto [low, high] = extent(f, axis);
    const double middle = (low + high) / 2,
                 least = of_length * std::sqrt(area_vector(mesh_, mesh_.triangles[f]).norm());
    if (high - low < least) return false;
    std::array<bool, 2> convex{true, true}, concave{true, true};  // on the lower side, on the upper
    for (const std::uint32_t v : mesh_.triangles[f]) {
      const std::size_t side = axis.dot(mesh_.vertices[v]) > middle;
      convex[side] = convex[side] && convex_[v];
      concave[side] = concave[side] && concave_[v];
    }
    return (convex[0] && concave[1]) || (concave[0] && convex[1]);
  }

  // Which vertices lie on edges of right angles, of either kind.
  void mark_corners() {
    if (!convex_.empty()) return;
    convex_.assign(mesh_.vertices.size(), 0);
    concave_.assign(mesh_.vertices.size(), 0);
    const std::vector<Triangle> neighbours = face_neighbours(mesh_, VertexStars(mesh_));
    for (std::size_t f = 0; f < neighbours.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t g = neighbours[f][k];
        if (g == no_face || !is_across(normals_[f], normals_[g])) continue;
        const Triangle &t = mesh_.triangles[f], &other = mesh_.triangles[g];
        double above = 0;
        for (const std::uint32_t v : other) above += normals_[f].dot(mesh_.vertices[v] - mesh_.vertices[t[0]]);
        for (const std::size_t j : {1U, 2U}) (above < 0 ? convex_ : concave_)[t[(k + j) % 3]] = 1;
      }
  }

  bool is_enough(std::size_t on_stairs) const {
    return static_cast<double>(on_stairs) >= least_stairs * static_cast<double>(normals_.size());
  }

  const SurfaceMesh& mesh_;
  std::vector<Vec3> normals_;
  std::vector<char> convex_, concave_;
};

}  // namespace

std::optional<StairSteps> find_stair_steps(const SurfaceMesh& mesh) {
  return StairFinder(mesh).find();
}

}  // namespace scan2fea
