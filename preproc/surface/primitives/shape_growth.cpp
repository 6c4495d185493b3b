#include "preproc/surface/primitives/shape_growth.hpp"

#include <algorithm>
#include <span>
#include <utility>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

// Points that decide a shape while it grows: more would move it by less than the noise.
constexpr std::size_t most_fitted = 200;

std::vector<Index> spread_over(const std::vector<Index>& members) {
  const std::size_t stride = 1 + members.size() / most_fitted;
  std::vector<Index> some;
  for (std::size_t k = 0; k < members.size(); k += stride) some.push_back(members[k]);
  return some;
}

}  // namespace

bool ShapeGrowth::grow(FoundShape& grown) {
  constexpr int most_rounds = 12, steps_while_growing = 4;
  std::vector<Index> members = grown.points;
  for (int round = 0; round < most_rounds; ++round) {
    if (!fit_shape(grown.shape, grown.freedom, cloud_.points, spread_over(members), noise_.sigma, steps_while_growing)
             .found)
      return false;
    if (members.size() > patch_size && rms_distance(cloud_, grown.shape, members) > 2 * noise_.sigma) {
      grown.points = std::move(members);
      return false;
    }
    // The axis has turned.
    if (grown.is_free()) grown.freedom = full_freedom(grown.shape);
    std::vector<Index> next = flooded(grown.shape, members, 3 * members.size());
    if (next.size() < 4) return false;
    const bool same = next == members;
    members = std::move(next);
    if (same) break;
  }
  grown.points = std::move(members);
  return rate(grown);
}

std::vector<Index> ShapeGrowth::flooded(const Shape& shape, const std::vector<Index>& from, std::size_t most) {
  ++round_;
  std::vector<Index> region;
  const auto visit = [&](Index i) {
    if (mark_[i] == round_) return;
    mark_[i] = round_;
    if (saving(shape, i) > 0) region.push_back(i);
  };
  for (const Index i : from) visit(i);
  for (std::size_t next = 0; next < region.size() && region.size() < most; ++next) {
    const auto near = neighbours_.of(region[next]);
    for (const Index j : near.first(std::min<std::size_t>(10, near.size()))) visit(j);
  }
  std::sort(region.begin(), region.end());
  return region;
}

// Of a point's cost, were the shape to describe it. Beside a shape that has it and runs the same way, costs that
// noise explains count alike: else each plane would lose the farther half of its noise to another one.
double ShapeGrowth::saving(const Shape& shape, Index i) const {
  constexpr double noise_alone = 10;  // exceeded by 1 % of squared distances and turns together
  constexpr double same_way = 0.985;  // cosine of 10 degrees
  const double cost = cost_of(cloud_, noise_, shape, i);
  if (!(cost < most_cost)) return 0;
  const Index label = described_.labels[i];
  if (label == no_shape) return cost_without_shape - cost;
  const Vec3& p = cloud_.points[i];
  if (described_.shapes[label].shape.normal(p).dot(shape.normal(p)) < same_way) return cost_[i] - cost;
  return std::max(cost_[i], noise_alone) - std::max(cost, noise_alone);
}

bool ShapeGrowth::rate(FoundShape& grown) const {
  double saved = 0;
  for (const Index i : grown.points) saved += saving(grown.shape, i);
  grown.gain = saved - description_cost(grown.shape.kind, grown.freedom);
  return grown.gain > 0 && leaves_noise(cloud_, neighbours_, noise_, grown.shape, grown.points);
}

}  // namespace scan2fea
