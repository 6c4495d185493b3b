#include "preproc/surface/reconstruction/seen_cells.hpp"

#include "preproc/surface/kernel/solid_angle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace scan2fea {
namespace {

class Viewing {
 public:
  Viewing(const std::vector<Vec3>& points, const std::vector<double>& spacing, const DelaunayCells& cells,
          const PointViews& views, double weight)
      : points_(points), spacing_(spacing), cells_(cells), views_(views), weight_(weight) {
    seen_.inside.assign(cells.corners.size(), 0.0);
    seen_.crossed.assign(cells.corners.size(), {0, 0, 0, 0});
    list_cells();
  }

  SeenCells run() {
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      // Of a lattice of equilateral triangles.
      const double area = weight_ * 0.5 * std::sqrt(3.0) * spacing_[i] * spacing_[i];
      if (!views_.normals.empty()) vote(i, area);
      if (!views_.scanners.empty() && views_.scanners[i].allFinite()) look(i, views_.scanners[i], area);
    }
    return std::move(seen_);
  }

 private:
  void list_cells() {
    first_.assign(points_.size() + 1, 0);
    for (const auto& corners : cells_.corners)
      for (const std::uint32_t v : corners)
        if (v != DelaunayCells::infinite) ++first_[v + 1];
    for (std::size_t i = 0; i < points_.size(); ++i) first_[i + 1] += first_[i];
    about_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t cell = 0; cell < cells_.corners.size(); ++cell)
      for (const std::uint32_t v : cells_.corners[cell])
        if (v != DelaunayCells::infinite) about_[next[v]++] = cell;
  }

  struct Place {
    std::uint32_t cell;
    std::size_t opposite;  // the corner
  };

  // The cell about a point into which a direction leads, by how deep inside its three sides there the direction runs.
  // Outside of the hull none is.
  std::optional<Place> cell_towards(std::uint32_t point, const Vec3& direction) const {
    std::optional<Place> best;
    double deepest = -1e-9;  // rounding: along a side, both cells are as good
    for (std::size_t k = first_[point]; k < first_[point + 1]; ++k) {
      const auto& corners = cells_.corners[about_[k]];
      if (std::ranges::find(corners, DelaunayCells::infinite) != corners.end()) continue;
      const auto own = static_cast<std::size_t>(std::ranges::find(corners, point) - corners.begin());
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t side = 0; side < 4; ++side)
        if (side != own) least = std::min(least, -outwards(about_[k], side).dot(direction));
      if (least <= deepest) continue;
      deepest = least;
      best = {about_[k], own};
    }
    return best;
  }

  Vec3 outwards(std::uint32_t cell, std::size_t opposite) const {
    const Triangle t = cells_.facet(cell, opposite);
    return (points_[t[1]] - points_[t[0]]).cross(points_[t[2]] - points_[t[0]]).normalized();
  }

  // All about the point, by how squarely a cell lies before or behind it.
  void vote(std::uint32_t point, double area) {
    for (std::size_t k = first_[point]; k < first_[point + 1]; ++k) {
      const auto& corners = cells_.corners[about_[k]];
      if (std::ranges::find(corners, DelaunayCells::infinite) != corners.end()) continue;
      std::array<Vec3, 3> way;
      std::size_t count = 0;
      for (const std::uint32_t v : corners)
        if (v != point) way[count++] = (points_[v] - points_[point]).normalized();
      const double angle = std::abs(solid_angle(way[0], way[1], way[2]));
      const Vec3 middle = (way[0] + way[1] + way[2]).normalized();
      seen_.inside[about_[k]] -= area * angle / std::numbers::pi * middle.dot(views_.normals[point]);
    }
  }

  void look(std::uint32_t point, const Vec3& scanner, double area) {
    const Vec3 way = scanner - points_[point];
    const double distance = way.norm();
    if (!(distance > 0)) return;
    const Vec3 direction = way / distance;
    std::optional<Place> place = cell_towards(point, direction);
    if (!place) return;
    constexpr double of_noise = 3;
    while (place) {
      const std::uint32_t next = cells_.neighbours[place->cell][place->opposite];
      const Triangle t = cells_.facet(place->cell, place->opposite);
      const Vec3 normal = outwards(place->cell, place->opposite);
      const double at = normal.dot(points_[t[0]] - points_[point]) / normal.dot(direction);
      if (at > distance) return;
      if (at > of_noise * views_.noise) seen_.crossed[place->cell][place->opposite] += area;
      place = leave(next, place->cell, point, direction);
    }
  }

  // The facet through which the view leaves a cell that it enters from another.
  std::optional<Place> leave(std::uint32_t cell, std::uint32_t from, std::uint32_t point, const Vec3& direction) const {
    const auto& corners = cells_.corners[cell];
    if (std::ranges::find(corners, DelaunayCells::infinite) != corners.end()) return std::nullopt;
    std::optional<Place> best;
    double first = std::numeric_limits<double>::infinity();
    for (std::size_t side = 0; side < 4; ++side) {
      if (cells_.neighbours[cell][side] == from) continue;
      const Vec3 normal = outwards(cell, side);
      const double slope = normal.dot(direction);
      if (!(slope > 0)) continue;
      const double at = normal.dot(points_[cells_.facet(cell, side)[0]] - points_[point]) / slope;
      if (at >= first) continue;
      first = at;
      best = {cell, side};
    }
    return best;
  }

  const std::vector<Vec3>& points_;
  const std::vector<double>& spacing_;
  const DelaunayCells& cells_;
  const PointViews& views_;
  double weight_;
  SeenCells seen_;
  std::vector<std::size_t> first_;    // of each point, in `about_`
  std::vector<std::uint32_t> about_;  // cells that have it
};

}  // namespace

SeenCells see_cells(const std::vector<Vec3>& points, const std::vector<double>& spacing, const DelaunayCells& cells,
                    const PointViews& views, double weight) {
  return Viewing(points, spacing, cells, views, weight).run();
}

}  // namespace scan2fea
