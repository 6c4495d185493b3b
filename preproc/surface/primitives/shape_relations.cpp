#include "preproc/surface/primitives/shape_relations.hpp"

#include "preproc/mesh/median.hpp"
#include "preproc/surface/primitives/blend.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

constexpr double parallel_cosine = 0.9976, square_cosine = 0.07;  // 4 degrees

double extent_of(const OrientedPoints& cloud, const FoundShape& found) {
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const Index i : found.points) {
    low = low.cwiseMin(cloud.points[i]);
    high = high.cwiseMax(cloud.points[i]);
  }
  return found.points.empty() ? 0 : (high - low).norm();
}

bool has_axis_line(ShapeKind kind) {
  return kind == ShapeKind::cylinder || kind == ShapeKind::cone || kind == ShapeKind::torus;
}

class Relater {
 public:
  Relater(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise, ShapeSet& set)
      : cloud_(cloud), neighbours_(neighbours), noise_(noise), set_(set) {}

  void run() {
    merge();
    release_radii();
    order_by_support();
    align_directions();
    make_tangent();
    join_axes();
    equal_radii();
  }

 private:
  // The best determined first: what their directions are known to goes with points and extent.
  void order_by_support() {
    std::vector<double> support;
    for (const FoundShape& found : set_.shapes)
      support.push_back(static_cast<double>(found.points.size()) * std::pow(extent_of(cloud_, found), 2));
    order_.resize(set_.shapes.size());
    std::iota(order_.begin(), order_.end(), Index{0});
    std::stable_sort(order_.begin(), order_.end(), [&](Index a, Index b) { return support[a] > support[b]; });
  }

  std::vector<Index> held_by(const Shape& shape, const std::vector<Index>& points) const {
    std::vector<Index> held;
    for (const Index i : points)
      if (cost_of(cloud_, noise_, shape, i) < most_cost) held.push_back(i);
    return held;
  }

  // Roundings get their own radius back, until it is known to be another's.
  void release_radii() {
    for (FoundShape& found : set_.shapes) {
      if (!found.relations.tangent_to) continue;
      const auto [one, other] = *found.relations.tangent_to;
      const auto blend =
          Blend::between(set_.shapes[one].shape, set_.shapes[other].shape, found.shape.hollow, found.shape.origin);
      if (!blend) continue;
      found.shape = blend->with_radius(blend_radius(found.shape));
      found.freedom = blend->freedom();
      fit_shape(found.shape, found.freedom, cloud_.points, found.points, noise_.sigma);
    }
  }

  // Fits the trial to the shape's points, and takes it if the description gets shorter.
  bool take_if_shorter(FoundShape& found, Shape trial, ShapeFreedom freedom) const {
    if (!fit_shape(trial, freedom, cloud_.points, found.points, noise_.sigma).found) return false;
    if (!(total_cost(cloud_, noise_, trial, freedom, found.points) <
          total_cost(cloud_, noise_, found.shape, found.freedom, found.points)))
      return false;
    if (!leaves_noise(cloud_, neighbours_, noise_, trial, held_by(trial, found.points))) return false;
    found.shape = trial;
    found.freedom = std::move(freedom);
    return true;
  }

  // Costs that noise explains count alike: of two planes that have shared the noise of one, each fits its half better.
  double lenient_cost(const Shape& shape, const std::vector<Index>& points) const {
    constexpr double noise_alone = 10;
    double cost = 0;
    for (const Index i : points) {
      const double of_point = cost_of(cloud_, noise_, shape, i);
      cost += of_point < most_cost ? std::max(of_point, noise_alone) : cost_without_shape;
    }
    return cost;
  }

  void merge() {
    std::vector<bool> kept(set_.shapes.size(), true);
    for (std::size_t a = 0; a < kept.size(); ++a)
      for (std::size_t b = a + 1; b < kept.size() && kept[a]; ++b)
        if (kept[b] && merged(set_.shapes[a], set_.shapes[b])) {
          for (const Index i : set_.shapes[b].points) set_.labels[i] = static_cast<Index>(a);
          for (FoundShape& found : set_.shapes)
            if (found.relations.tangent_to)
              for (Index& side : *found.relations.tangent_to)
                if (side == b) side = static_cast<Index>(a);
          kept[b] = false;
        }
    for (FoundShape& found : set_.shapes)
      if (found.relations.tangent_to && (*found.relations.tangent_to)[0] == (*found.relations.tangent_to)[1]) {
        found.relations.tangent_to.reset();
        found.freedom = freedom_on_direction(found.shape);
      }
    keep_shapes(set_, kept);
  }

  bool merged(FoundShape& one, FoundShape& other) const {
    if (one.shape.kind != other.shape.kind || one.shape.hollow != other.shape.hollow ||
        !nearly_one(one.shape, other.shape))
      return false;
    FoundShape& larger = one.points.size() < other.points.size() ? other : one;
    Shape trial = larger.shape;
    ShapeFreedom freedom = larger.freedom;
    std::vector<Index> points;
    std::merge(one.points.begin(), one.points.end(), other.points.begin(), other.points.end(),
               std::back_inserter(points));
    if (!fit_shape(trial, freedom, cloud_.points, points, noise_.sigma).found) return false;
    if (lenient_cost(trial, points) - lenient_cost(one.shape, one.points) - lenient_cost(other.shape, other.points) >
        description_cost(trial.kind, one.freedom))
      return false;
    const ShapeRelations relations = larger.relations;
    one.shape = trial;
    one.freedom = std::move(freedom);
    one.points = std::move(points);
    one.relations = relations;
    return true;
  }

  bool nearly_one(const Shape& a, const Shape& b) const {
    if (a.kind == ShapeKind::plane) return a.axis.dot(b.axis) > 0.9;  // the points of both tell the rest
    const double reach = 0.2 * a.radius;
    if ((a.kind == ShapeKind::sphere || a.kind == ShapeKind::torus) && (a.origin - b.origin).norm() > reach)
      return false;
    if (a.kind != ShapeKind::sphere && std::abs(a.axis.dot(b.axis)) < 0.9) return false;
    if (a.kind == ShapeKind::cone) return (b.origin - a.origin).cross(a.axis).norm() < reach;
    return std::abs(a.radius - b.radius) < reach &&
           (a.kind != ShapeKind::cylinder || (b.origin - a.origin).cross(a.axis).norm() < reach);
  }

  void align_directions() {
    std::vector<Index> leaders;
    for (const Index s : order_) {
      FoundShape& found = set_.shapes[s];
      if (found.shape.kind == ShapeKind::sphere || found.relations.tangent_to) continue;
      free_direction(found);
      if (!align(found, leaders)) leaders.push_back(s);
    }
  }

  // Back to what the points say of it.
  void free_direction(FoundShape& found) const {
    found.relations.parallel_to.reset();
    found.relations.coaxial_to.reset();
    if (found.is_free()) return;
    Shape freed = found.shape;
    const ShapeFreedom freedom = full_freedom(freed);
    if (!fit_shape(freed, freedom, cloud_.points, found.points, noise_.sigma).found) return;
    if (!leaves_noise(cloud_, neighbours_, noise_, freed, found.points)) return;
    found.shape = freed;
    found.freedom = full_freedom(freed);
  }

  // True where it has the direction of a leader, or one square to two of them.
  bool align(FoundShape& found, const std::vector<Index>& leaders) const {
    const Vec3 axis = found.shape.axis;
    const auto take = [&](const Vec3& direction) {
      Shape trial = found.shape;
      trial.axis = direction.dot(axis) < 0 ? Vec3(-direction) : direction;
      if (trial.kind == ShapeKind::cone && direction.dot(axis) < 0) trial.axis = -direction;
      return take_if_shorter(found, trial, freedom_on_direction(trial));
    };
    for (const Index leader : leaders) {
      const Vec3& direction = set_.shapes[leader].shape.axis;
      if (std::abs(direction.dot(axis)) < parallel_cosine || !take(direction)) continue;
      found.relations.parallel_to = leader;
      return true;
    }
    for (std::size_t a = 0; a < leaders.size(); ++a)
      for (std::size_t b = a + 1; b < leaders.size(); ++b) {
        const Vec3 square = set_.shapes[leaders[a]].shape.axis.cross(set_.shapes[leaders[b]].shape.axis);
        if (square.norm() < 0.5) continue;
        // It is a direction of its own, that others may follow.
        if (std::abs(square.normalized().dot(axis)) > parallel_cosine && take(square.normalized())) return false;
      }
    for (const Index leader : leaders) {
      const Vec3& direction = set_.shapes[leader].shape.axis;
      if (std::abs(direction.dot(axis)) > square_cosine) continue;
      Shape trial = found.shape;
      trial.axis = (axis - axis.dot(direction) * direction).normalized();
      ShapeFreedom freedom = freedom_on_direction(trial);
      freedom.push_back({.tilt = direction.cross(trial.axis)});
      if (take_if_shorter(found, trial, freedom)) return false;
    }
    return false;
  }

  // The shapes whose points are neighbours of this one's, those of most contacts first.
  std::vector<Index> sides_of(const FoundShape& found, Index own) const {
    std::map<Index, std::size_t> contacts;
    for (const Index i : found.points)
      for (const Index j : neighbours_.of(i))
        if (set_.labels[j] != no_shape && set_.labels[j] != own) ++contacts[set_.labels[j]];
    std::vector<Index> sides;
    for (const auto& [side, count] : contacts)
      if (!set_.shapes[side].relations.tangent_to) sides.push_back(side);
    std::stable_sort(sides.begin(), sides.end(), [&](Index a, Index b) { return contacts[a] > contacts[b]; });
    if (sides.size() > 5) sides.resize(5);
    return sides;
  }

  void make_tangent() {
    for (Index s = 0; s < set_.shapes.size(); ++s) {
      FoundShape& found = set_.shapes[s];
      if (found.shape.kind == ShapeKind::plane || found.relations.tangent_to || found.points.empty()) continue;
      const std::vector<Index> sides = sides_of(found, s);
      for (std::size_t a = 0; a < sides.size() && !found.relations.tangent_to; ++a)
        for (std::size_t b = a + 1; b < sides.size() && !found.relations.tangent_to; ++b)
          if (became_blend(found, sides[a], sides[b])) found.relations.tangent_to = std::array{sides[a], sides[b]};
    }
  }

  bool became_blend(FoundShape& found, Index one, Index other) const {
    const Vec3& somewhere = cloud_.points[found.points[found.points.size() / 2]];
    const auto blend = Blend::between(set_.shapes[one].shape, set_.shapes[other].shape, found.shape.hollow, somewhere);
    if (!blend) return false;
    std::vector<double> radii;
    for (const Index i : found.points)
      if (const auto radius = blend->radius_through(cloud_.points[i])) radii.push_back(*radius);
    if (2 * radii.size() < found.points.size()) return false;
    return take_if_shorter(found, blend->with_radius(median(std::move(radii))), blend->freedom());
  }

  void join_axes() {
    for (std::size_t k = 1; k < order_.size(); ++k) {
      FoundShape& found = set_.shapes[order_[k]];
      if (found.shape.kind == ShapeKind::plane || found.relations.tangent_to) continue;
      for (std::size_t j = 0; j < k && !found.relations.coaxial_to; ++j) {
        const FoundShape& leader = set_.shapes[order_[j]];
        if (!has_axis_line(leader.shape.kind)) continue;
        const bool ball = found.shape.kind == ShapeKind::sphere;
        if (!ball && std::abs(leader.shape.axis.dot(found.shape.axis)) < parallel_cosine) continue;
        Shape trial = found.shape;
        if (ball || trial.axis.dot(leader.shape.axis) > 0)
          trial.axis = leader.shape.axis;
        else
          trial.axis = -leader.shape.axis;
        trial.origin = leader.shape.origin + (found.shape.origin - leader.shape.origin).dot(trial.axis) * trial.axis;
        if ((trial.origin - found.shape.origin).norm() > 0.5 * found.shape.radius) continue;
        if (take_if_shorter(found, trial, freedom_on_axis(trial))) found.relations.coaxial_to = order_[j];
      }
    }
  }

  // The change that the radius goes with, if it is free.
  static std::optional<std::size_t> radius_change(const FoundShape& found) {
    for (std::size_t i = 0; i < found.freedom.size(); ++i) {
      const ShapeChange& change = found.freedom[i];
      if ((found.shape.kind == ShapeKind::torus ? change.second : change.radius) != 0) return i;
    }
    return std::nullopt;
  }

  void equal_radii() {
    std::vector<Index> by_points = order_;
    std::stable_sort(by_points.begin(), by_points.end(),
                     [&](Index a, Index b) { return set_.shapes[a].points.size() > set_.shapes[b].points.size(); });
    for (std::size_t k = 1; k < by_points.size(); ++k) {
      FoundShape& found = set_.shapes[by_points[k]];
      found.relations.same_radius_as.reset();
      if (found.shape.kind == ShapeKind::plane || found.shape.kind == ShapeKind::cone) continue;
      for (std::size_t j = 0; j < k && !found.relations.same_radius_as; ++j)
        if (became_equal(found, set_.shapes[by_points[j]])) found.relations.same_radius_as = by_points[j];
    }
  }

  bool became_equal(FoundShape& found, const FoundShape& leader) const {
    // Nominal sizes closer than this are seldom two.
    constexpr double nearly = 0.1;
    if (leader.shape.kind != found.shape.kind || leader.shape.hollow != found.shape.hollow ||
        leader.relations.same_radius_as)
      return false;
    const double own = blend_radius(found.shape), wanted = blend_radius(leader.shape);
    const auto at = radius_change(found);
    if (!at || std::abs(own - wanted) > nearly * wanted) return false;
    const ShapeChange change = found.freedom[*at];
    Shape trial = found.shape;
    trial.origin += (wanted - own) * change.shift;
    trial.radius += (wanted - own) * change.radius;
    trial.tube_radius += (wanted - own) * change.second;
    ShapeFreedom freedom = found.freedom;
    freedom.erase(freedom.begin() + static_cast<std::ptrdiff_t>(*at));
    return take_if_shorter(found, trial, std::move(freedom));
  }

  const OrientedPoints& cloud_;
  const Neighbours& neighbours_;
  const ShapeNoise& noise_;
  ShapeSet& set_;
  std::vector<Index> order_;  // of shapes, by support
};

}  // namespace

void impose_relations(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise,
                      ShapeSet& set) {
  Relater(cloud, neighbours, noise, set).run();
}

}  // namespace scan2fea
