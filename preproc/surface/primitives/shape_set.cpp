#include "preproc/surface/primitives/shape_set.hpp"

#include "preproc/surface/primitives/blend.hpp"

#include <algorithm>

namespace scan2fea {
namespace {

using Index = std::uint32_t;

// Of a degree of freedom, in squared sigmas. A point that is described saves up to 20, so that a plane needs four good
// points or more poor ones.
constexpr double freedom_cost = 20;

// Roundings follow what they are tangent to.
void follow_sides(ShapeSet& set) {
  for (FoundShape& found : set.shapes) {
    if (!found.relations.tangent_to) continue;
    const auto [one, other] = *found.relations.tangent_to;
    const auto blend =
        Blend::between(set.shapes[one].shape, set.shapes[other].shape, found.shape.hollow, found.shape.origin);
    if (!blend) continue;
    found.shape = blend->with_radius(blend_radius(found.shape));
    if (!found.freedom.empty()) found.freedom = blend->freedom();
  }
}

// Shapes whose points save less than the shape costs, or do not look like noise beside it.
void drop_unpaid(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise, ShapeSet& set) {
  std::vector<bool> kept(set.shapes.size());
  for (std::size_t s = 0; s < set.shapes.size(); ++s) {
    FoundShape& found = set.shapes[s];
    found.gain = cost_without_shape * static_cast<double>(found.points.size()) -
                 total_cost(cloud, noise, found.shape, found.freedom, found.points);
    kept[s] = found.gain > 0 && leaves_noise(cloud, neighbours, noise, found.shape, found.points);
  }
  keep_shapes(set, kept);
}

}  // namespace

double description_cost(ShapeKind kind, const ShapeFreedom& freedom) {
  // A free piece of torus or cone can follow nearly any few points, and is rarer than a plane or cylinder.
  const double rarity = freedom.size() < 2          ? 0
                        : kind == ShapeKind::torus  ? 3
                        : kind == ShapeKind::cone   ? 2
                        : kind == ShapeKind::sphere ? 1
                                                    : 0;
  return freedom_cost * (static_cast<double>(freedom.size()) + rarity);
}

double total_cost(const OrientedPoints& cloud, const ShapeNoise& noise, const Shape& shape, const ShapeFreedom& freedom,
                  std::span<const Index> points) {
  double cost = description_cost(shape.kind, freedom);
  for (const Index i : points) {
    const double of_point = cost_of(cloud, noise, shape, i);
    cost += of_point < most_cost ? of_point : cost_without_shape;
  }
  return cost;
}

void keep_shapes(ShapeSet& set, const std::vector<bool>& kept) {
  std::vector<Index> renamed(set.shapes.size(), no_shape);
  std::vector<FoundShape> shapes;
  for (std::size_t s = 0; s < set.shapes.size(); ++s) {
    if (!kept[s]) continue;
    renamed[s] = static_cast<Index>(shapes.size());
    shapes.push_back(std::move(set.shapes[s]));
  }
  for (Index& label : set.labels)
    if (label != no_shape) label = renamed[label];
  for (FoundShape& found : shapes) {
    ShapeRelations& relations = found.relations;
    if (relations.tangent_to) {
      for (Index& side : *relations.tangent_to) side = renamed[side];
      if ((*relations.tangent_to)[0] == no_shape || (*relations.tangent_to)[1] == no_shape) {
        relations.tangent_to.reset();
        found.freedom = freedom_on_direction(found.shape);
      }
    }
    for (auto* other : {&relations.parallel_to, &relations.coaxial_to, &relations.same_radius_as}) {
      if (!*other) continue;
      **other = renamed[**other];
      if (**other == no_shape) other->reset();
    }
  }
  set.shapes = std::move(shapes);
}

void relabel_points(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise, ShapeSet& set) {
  constexpr std::size_t asked = 10;
  std::vector<Index> labels(set.labels.size(), no_shape);
  std::vector<Index> tried;
  for (Index i = 0; i < labels.size(); ++i) {
    tried.clear();
    double least = most_cost;
    const auto try_shape = [&](Index label) {
      if (label == no_shape || std::find(tried.begin(), tried.end(), label) != tried.end()) return;
      tried.push_back(label);
      const double cost = cost_of(cloud, noise, set.shapes[label].shape, i);
      if (!(cost < least)) return;
      least = cost;
      labels[i] = label;
    };
    try_shape(set.labels[i]);
    const auto near = neighbours.of(i);
    for (const Index j : near.first(std::min(asked, near.size()))) try_shape(set.labels[j]);
  }
  set.labels = std::move(labels);
  for (FoundShape& found : set.shapes) found.points.clear();
  for (Index i = 0; i < set.labels.size(); ++i)
    if (set.labels[i] != no_shape) set.shapes[set.labels[i]].points.push_back(i);
}

void compete_for_points(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise, int rounds,
                        ShapeSet& set) {
  for (int round = 0; round < rounds; ++round) {
    relabel_points(cloud, neighbours, noise, set);
    drop_unpaid(cloud, neighbours, noise, set);
    follow_sides(set);
    for (FoundShape& found : set.shapes) {
      Shape fitted = found.shape;
      if (!fit_shape(fitted, found.freedom, cloud.points, found.points, noise.sigma).found) continue;
      found.shape = fitted;
      if (found.is_free()) found.freedom = full_freedom(fitted);  // the axis has turned
    }
  }
}

}  // namespace scan2fea
