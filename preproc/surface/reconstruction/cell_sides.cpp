#include "preproc/surface/reconstruction/cell_sides.hpp"

#include "preproc/surface/reconstruction/hole_voids.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace scan2fea {
namespace {

class Sides {
 public:
  Sides(const std::vector<Vec3>& points, const DelaunayCells& cells, const Primitives& found)
      : points_(points), cells_(cells), found_(found), holes_(find_hole_voids(points, found)) {}

  CellSide of(std::uint32_t cell) const {
    Vec3 centre = Vec3::Zero();
    for (const std::uint32_t v : cells_.corners[cell]) {
      if (v == DelaunayCells::infinite) return CellSide::unknown;
      centre += points_[v] / 4;
    }
    return is_in_hole(cell, centre) ? CellSide::outside : by_corners(cells_.corners[cell], centre);
  }

 private:
  double near() const { return 2 * found_.sigma; }

  bool is_in_hole(std::uint32_t cell, const Vec3& centre) const {
    return std::ranges::any_of(holes_,
                               [&](const HoleVoid& hole) { return hole.contains(centre) || has_axis(cell, hole); });
  }

  // Whether the axis runs through the cell: by what the four sides leave of it.
  bool has_axis(std::uint32_t cell, const HoleVoid& hole) const {
    double from = hole.low + hole.margin, to = hole.high - hole.margin;
    for (std::size_t side = 0; side < 4 && from < to; ++side) {
      const Triangle t = cells_.facet(cell, side);
      const Vec3 outwards = (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]);
      const double slope = outwards.dot(hole.shape.axis), room = outwards.dot(points_[t[0]] - hole.shape.origin);
      if (slope > 0) to = std::min(to, room / slope);
      if (slope < 0) from = std::max(from, room / slope);
      if (slope == 0 && room < 0) return false;
    }
    return from < to;
  }

  double distance(std::uint32_t label, const Vec3& p) const { return found_.list[label].shape.signed_distance(p); }

  // Whether a rounding is the surface where p is, between the two shapes that it joins, by directions.
  bool is_in_sector(const Primitive& blend, const Vec3& p) const {
    const auto [one, other] = *blend.relations.tangent_to;
    const Vec3 n = blend.shape.normal(p), a = found_.list[one].shape.normal(p), b = found_.list[other].shape.normal(p);
    return n.dot(a - a.dot(b) * b) > 0 && n.dot(b - a.dot(b) * a) > 0;
  }

  // The shapes of the corners that count at p: a rounding instead of those that it joins, or these instead of it.
  std::vector<std::uint32_t> shapes_at(const std::array<std::uint32_t, 4>& corners, const Vec3& p) const {
    std::vector<std::uint32_t> labels, superseded;
    for (const std::uint32_t v : corners) {
      const std::uint32_t label = found_.labels[v];
      if (label == no_primitive) return {};
      labels.push_back(label);
      const Primitive& primitive = found_.list[label];
      if (!primitive.relations.tangent_to) continue;
      if (is_in_sector(primitive, p))
        superseded.insert(superseded.end(), primitive.relations.tangent_to->begin(),
                          primitive.relations.tangent_to->end());
      else
        superseded.push_back(label);
    }
    std::ranges::sort(labels);
    labels.erase(std::unique(labels.begin(), labels.end()), labels.end());
    std::erase_if(labels,
                  [&](std::uint32_t label) { return std::ranges::find(superseded, label) != superseded.end(); });
    return labels;
  }

  CellSide by_corners(const std::array<std::uint32_t, 4>& corners, const Vec3& centre) const {
    const std::vector<std::uint32_t> labels = shapes_at(corners, centre);
    if (labels.empty()) return CellSide::unknown;
    std::vector<std::uint32_t> before, behind;
    for (const std::uint32_t label : labels) {
      const double away = distance(label, centre);
      if (away > near()) before.push_back(label);
      if (away < -near()) behind.push_back(label);
    }
    if (before.size() == labels.size()) return CellSide::outside;
    if (behind.size() == labels.size()) return CellSide::inside;
    CellSide side = CellSide::unknown;
    for (const std::uint32_t one : before)
      for (const std::uint32_t other : behind) {
        const CellSide here = by_edge(corners, one, other);
        if (here == CellSide::unknown || (side != CellSide::unknown && side != here)) return CellSide::unknown;
        side = here;
      }
    return side;
  }

  // Before the one shape, behind the other.
  CellSide by_edge(const std::array<std::uint32_t, 4>& corners, std::uint32_t one, std::uint32_t other) const {
    double most = -std::numeric_limits<double>::infinity(), least = -most;
    for (const std::uint32_t v : corners) {
      const std::uint32_t label = found_.labels[v];
      if (label != one && label != other) continue;
      const double d = distance(label == one ? other : one, points_[v]);
      most = std::max(most, d);
      least = std::min(least, d);
    }
    if (most <= near() && least < -near()) return CellSide::outside;
    if (least >= -near() && most > near()) return CellSide::inside;
    return CellSide::unknown;
  }

  const std::vector<Vec3>& points_;
  const DelaunayCells& cells_;
  const Primitives& found_;
  std::vector<HoleVoid> holes_;
};

}  // namespace

std::vector<CellSide> sides_by_shapes(const std::vector<Vec3>& points, const DelaunayCells& cells,
                                      const Primitives& found) {
  const Sides sides(points, cells, found);
  std::vector<CellSide> result;
  for (std::uint32_t cell = 0; cell < cells.corners.size(); ++cell) result.push_back(sides.of(cell));
  return result;
}

}  // namespace scan2fea
