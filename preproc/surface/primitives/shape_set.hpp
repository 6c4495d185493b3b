// Shapes and the points that each of them describes.
// A point costs the squares of its distance from its shape and of its normal's turn, each over what noise explains; one
// without a shape costs more than any that has one; a shape costs its degrees of freedom. The sum is a description
// length; all decisions (whether a shape is one, whether two are one, whether a relation holds) are those that make it
// shorter.
#pragma once

#include "preproc/surface/primitives/fit_shape.hpp"
#include "preproc/surface/primitives/neighbours.hpp"
#include "preproc/surface/primitives/shape_rating.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace scan2fea {

inline constexpr std::uint32_t no_shape = ~std::uint32_t{0};

struct FoundShape {
  Shape shape;
  ShapeFreedom freedom;               // what may still change; less than the kind has where relations hold it
  std::vector<std::uint32_t> points;  // that it describes, ascending
  double gain = 0;                    // of description length
  ShapeRelations relations;

  // Nothing but its points decides it.
  bool is_free() const { return freedom.size() == static_cast<std::size_t>(degrees_of_freedom(shape.kind)); }
};

struct ShapeSet {
  std::vector<FoundShape> shapes;
  std::vector<std::uint32_t> labels;  // per point, in `shapes`; no_shape: none
};

// Of a point without a shape: more than of one that its shape just holds.
inline constexpr double cost_without_shape = 20;

// Of a shape that may change so.
double description_cost(ShapeKind kind, const ShapeFreedom& freedom);

// Of a shape and its points together, those that it does not hold left without.
double total_cost(const OrientedPoints& cloud, const ShapeNoise& noise, const Shape& shape, const ShapeFreedom& freedom,
                  std::span<const std::uint32_t> points);

// Takes shapes out of the set; `kept` per shape. Their points have none then, and relations to them end.
void keep_shapes(ShapeSet& set, const std::vector<bool>& kept);

// Each point goes to the shape of its own or of a neighbour that costs least.
void relabel_points(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise, ShapeSet& set);

// The same, then shapes are fitted to what they have, and those that no longer pay are dropped; `rounds` times.
void compete_for_points(const OrientedPoints& cloud, const Neighbours& neighbours, const ShapeNoise& noise, int rounds,
                        ShapeSet& set);

}  // namespace scan2fea
