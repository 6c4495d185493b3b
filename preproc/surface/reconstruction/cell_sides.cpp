#include "preproc/surface/reconstruction/cell_sides.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace scan2fea {
namespace {

// Of a hole, by its points.
struct Void {
  const Shape* shape;
  double low = std::numeric_limits<double>::infinity(), high = -low;  // along its axis
};

class Sides {
 public:
  Sides(const std::vector<Vec3>& points, const DelaunayCells& cells, const Primitives& found)
      : points_(points), cells_(cells), found_(found) {
    std::vector<Void> all;
    for (const Primitive& primitive : found.list) all.push_back({&primitive.shape});
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (found.labels[i] == no_primitive) continue;
      Void& hole = all[found.labels[i]];
      const double height = (points[i] - hole.shape->origin).dot(hole.shape->axis);
      hole.low = std::min(hole.low, height);
      hole.high = std::max(hole.high, height);
    }
    for (std::size_t k = 0; k < all.size(); ++k)
      if (found.list[k].use == PrimitiveUse::hole) holes_.push_back(all[k]);
  }

  CellSide of(std::uint32_t cell) const {
    Vec3 centre = Vec3::Zero();
    for (const std::uint32_t v : cells_.corners[cell]) {
      if (v == DelaunayCells::infinite) return CellSide::unknown;
      centre += points_[v] / 4;
    }
    return is_in_hole(centre) ? CellSide::outside : by_corners(cells_.corners[cell], centre);
  }

 private:
  double near() const { return 2 * found_.sigma; }

  bool is_in_hole(const Vec3& p) const {
    return std::ranges::any_of(holes_, [&](const Void& hole) {
      const double height = (p - hole.shape->origin).dot(hole.shape->axis);
      return height > hole.low && height < hole.high && hole.shape->signed_distance(p) > near();
    });
  }

  double distance(std::uint32_t label, const Vec3& p) const { return found_.list[label].shape.signed_distance(p); }

  CellSide by_corners(const std::array<std::uint32_t, 4>& corners, const Vec3& centre) const {
    std::array<std::uint32_t, 4> label;
    std::array<double, 4> away;
    bool is_before = true, is_behind = true;
    for (std::size_t k = 0; k < 4; ++k) {
      label[k] = found_.labels[corners[k]];
      if (label[k] == no_primitive) return CellSide::unknown;
      away[k] = distance(label[k], centre);
      is_before = is_before && away[k] > near();
      is_behind = is_behind && away[k] < -near();
    }
    if (is_before) return CellSide::outside;
    if (is_behind) return CellSide::inside;
    CellSide side = CellSide::unknown;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 4; ++k) {
        if (away[i] <= near() || away[k] >= -near()) continue;
        const CellSide here = by_edge(corners, label, label[i], label[k]);
        if (here == CellSide::unknown || (side != CellSide::unknown && side != here)) return CellSide::unknown;
        side = here;
      }
    return side;
  }

  // Before the one shape, behind the other.
  CellSide by_edge(const std::array<std::uint32_t, 4>& corners, const std::array<std::uint32_t, 4>& label,
                   std::uint32_t one, std::uint32_t other) const {
    double most = -std::numeric_limits<double>::infinity(), least = -most;
    for (std::size_t k = 0; k < 4; ++k) {
      if (label[k] != one && label[k] != other) continue;
      const double d = distance(label[k] == one ? other : one, points_[corners[k]]);
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
  std::vector<Void> holes_;
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
