#include "examples/scanner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace scan2fea {
namespace {

struct Hit {
  double distance = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = 0;
};

// One position: lines of rays through a plane at distance 1, `angle` turned about the view.
class View {
 public:
  View(const Vec3& position, const Vec3& target, double angle, double half_width)
      : position_(position), half_width_(half_width) {
    ahead_ = (target - position).normalized();
    const Vec3 side = ahead_.unitOrthogonal(), up = ahead_.cross(side);
    along_ = std::cos(angle) * side + std::sin(angle) * up;
    across_ = ahead_.cross(along_);
  }

  // Rays that hit the surface first, of `lines` lines that swell and shrink and `columns` points on each.
  std::vector<Hit> cast(const SurfaceMesh& surface, std::size_t lines, std::size_t columns,
                        std::mt19937_64& generator) {
    lay_lines(lines, columns, generator);
    std::vector<Hit> hits(lines * columns);
    for (std::uint32_t f = 0; f < surface.triangles.size(); ++f) rasterize(surface, f, hits);
    return hits;
  }

  Vec3 direction(std::size_t ray) const {
    return (ahead_ + column_at(ray % columns_) * along_ + line_[ray / columns_] * across_).normalized();
  }
  const Vec3& position() const { return position_; }

 private:
  void lay_lines(std::size_t lines, std::size_t columns, std::mt19937_64& generator) {
    constexpr double swell = 0.35, jitter = 0.1;
    std::uniform_real_distribution<double> any(-jitter, jitter);
    columns_ = columns;
    line_.clear();
    double sum = 0;
    const double phase = any(generator) / jitter * std::numbers::pi;
    for (std::size_t i = 0; i < lines; ++i) {
      line_.push_back(sum);
      const double way = static_cast<double>(i) / static_cast<double>(lines);
      sum += 1 + swell * std::sin(6 * std::numbers::pi * way + phase) + any(generator);
    }
    for (double& at : line_) at = half_width_ * (2 * at / sum - 1);
  }
  double column_at(std::size_t column) const {
    return half_width_ * ((2 * static_cast<double>(column) + 1) / static_cast<double>(columns_) - 1);
  }

  void rasterize(const SurfaceMesh& surface, std::uint32_t f, std::vector<Hit>& hits) const {
    std::array<Vec3, 3> corner;
    double low_u = std::numeric_limits<double>::infinity(), high_u = -low_u, low_v = low_u, high_v = -low_u;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 way = surface.vertices[surface.triangles[f][k]] - position_;
      corner[k] = {way.dot(along_), way.dot(across_), way.dot(ahead_)};
      const double u = corner[k].x() / corner[k].z(), v = corner[k].y() / corner[k].z();
      low_u = std::min(low_u, u), high_u = std::max(high_u, u);
      low_v = std::min(low_v, v), high_v = std::max(high_v, v);
    }
    const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double offset = normal.dot(corner[0]);
    const double scale = static_cast<double>(columns_) / (2 * half_width_);
    const auto column = [&](double u) {
      return std::clamp((u + half_width_) * scale - 0.5, -1.0, static_cast<double>(columns_));
    };
    const auto first = static_cast<std::ptrdiff_t>(std::ceil(column(low_u))),
               last = static_cast<std::ptrdiff_t>(std::floor(column(high_u)));
    for (auto line = std::ranges::lower_bound(line_, low_v); line != line_.end() && *line <= high_v; ++line)
      for (std::ptrdiff_t c = std::max<std::ptrdiff_t>(first, 0); c <= last && c < std::ptrdiff_t(columns_); ++c) {
        const Vec3 ray(column_at(static_cast<std::size_t>(c)), *line, 1);
        const double slope = normal.dot(ray);
        if (slope == 0) continue;
        const double distance = offset / slope * ray.norm();
        Hit& hit = hits[static_cast<std::size_t>(line - line_.begin()) * columns_ + static_cast<std::size_t>(c)];
        if (distance > 0 && distance < hit.distance && is_within(corner, ray)) hit = {distance, f};
      }
  }

  static bool is_within(const std::array<Vec3, 3>& corner, const Vec3& ray) {
    int positive = 0, negative = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double side = ray.dot(corner[k].cross(corner[(k + 1) % 3]));
      positive += side > 0;
      negative += side < 0;
    }
    return positive == 0 || negative == 0;
  }

  Vec3 position_, ahead_, along_, across_;
  double half_width_;
  std::size_t columns_ = 0;
  std::vector<double> line_;
};

class Scanner {
 public:
  Scanner(const SurfaceMesh& surface, const ScannerOptions& options)
      : surface_(surface), options_(options), generator_(options.seed) {
    box_ = bounding_box(surface.vertices);
    centre_ = 0.5 * (box_.low + box_.high);
    diagonal_ = box_.diagonal();
    turn_ = enclosed_volume(surface) < 0 ? -1 : 1;
    place_views();
    thin_patches();
  }

  ScannedCloud run() {
    constexpr std::size_t coarse = 100;  // lines, to see how much of the view the part fills
    std::size_t seen = measure_all(coarse, std::size_t(coarse * options_.line_ratio)).size();
    const double growth =
        std::sqrt(1.1 * static_cast<double>(options_.points) / static_cast<double>(std::max<std::size_t>(seen, 1)));
    const double lines = std::max(2.0, coarse * growth);
    std::vector<Measured> all =
        measure_all(static_cast<std::size_t>(lines), static_cast<std::size_t>(lines * options_.line_ratio));
    keep_some(all);
    return finish(all);
  }

 private:
  struct Measured {
    std::size_t view;
    Vec3 ray;
    double distance;
    std::uint32_t triangle;
  };

  Vec3 outwards(std::uint32_t triangle) const {
    return turn_ * area_vector(surface_, surface_.triangles[triangle]).normalized();
  }

  void place_views() {
    constexpr double away = 2;  // diagonals from the centre; the part then fills less than `half_width`
    constexpr double half_width = 0.3;
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < options_.positions; ++i) {
      // The six sides, then the eight corners, a little beside both.
      Vec3 side = Vec3::Zero();
      const int k = i % 14;
      if (k < 6)
        side[k / 2] = k % 2 == 0 ? 1 : -1;
      else
        side = Vec3((k - 6) & 1 ? 1 : -1, (k - 6) & 2 ? 1 : -1, (k - 6) & 4 ? 1 : -1);
      side = (side.normalized() + 0.3 * Vec3(any(generator_), any(generator_), any(generator_))).normalized();
      views_.emplace_back(centre_ + away * diagonal_ * side, centre_, std::numbers::pi * any(generator_), half_width);
    }
  }

  void thin_patches() {
    std::uniform_int_distribution<std::size_t> vertex(0, surface_.vertices.size() - 1);
    std::uniform_real_distribution<double> radius(0.05, 0.11);
    for (int i = 0; i < options_.thinned_patches; ++i)
      patches_.push_back({surface_.vertices[vertex(generator_)], radius(generator_) * diagonal_});
  }

  std::vector<Measured> measure_all(std::size_t lines, std::size_t columns) {
    std::vector<Measured> all;
    std::uniform_real_distribution<double> any(0, 1);
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const std::vector<Hit> hits = views_[v].cast(surface_, lines, columns, generator_);
      for (std::size_t ray = 0; ray < hits.size(); ++ray) {
        if (!std::isfinite(hits[ray].distance)) continue;
        const Vec3 direction = views_[v].direction(ray);
        const Vec3 normal = outwards(hits[ray].triangle);
        if (-normal.dot(direction) < options_.grazing) continue;
        const Vec3 place = views_[v].position() + hits[ray].distance * direction;
        const bool is_thinned =
            std::ranges::any_of(patches_, [&](const Ball& ball) { return (place - ball.centre).norm() < ball.radius; });
        if (is_thinned && any(generator_) > options_.thinned_to) continue;
        all.push_back({v, direction, hits[ray].distance, hits[ray].triangle});
      }
    }
    return all;
  }

  // Of the diagonal, from a random number of 0 to 1.
  double outlier_distance(double random) const {
    return options_.outlier_kind == OutlierKind::near_surface ? 0.005 + 0.01 * random : 0.01 + 0.03 * random;
  }

  // Any of them, in their order.
  void keep_some(std::vector<Measured>& all) {
    if (all.size() <= options_.points) return;
    std::vector<Measured> kept;
    std::ranges::sample(all, std::back_inserter(kept), static_cast<std::ptrdiff_t>(options_.points), generator_);
    all = std::move(kept);
  }

  ScannedCloud finish(const std::vector<Measured>& all) {
    ScannedCloud result;
    std::normal_distribution<double> noise(0, 1);
    std::uniform_real_distribution<double> any(0, 1);
    for (const Measured& m : all) {
      const bool is_outlier = any(generator_) < options_.outliers;
      const double side = any(generator_) < 0.5 ? -1 : 1;
      const double off = is_outlier ? side * outlier_distance(any(generator_)) : options_.noise * noise(generator_);
      Vec3 place = views_[m.view].position() + (m.distance + off * diagonal_) * m.ray;
      if (is_outlier && options_.outlier_kind == OutlierKind::in_box)
        for (Eigen::Index k = 0; k < 3; ++k) place[k] = std::lerp(box_.low[k], box_.high[k], any(generator_));
      result.cloud.points.push_back(place);
      result.cloud.normals.push_back(outwards(m.triangle));
      result.cloud.scanners.push_back(views_[m.view].position());
      result.is_outlier.push_back(is_outlier);
    }
    return result;
  }

  const SurfaceMesh& surface_;
  const ScannerOptions& options_;
  std::mt19937_64 generator_;
  BoundingBox box_;
  Vec3 centre_ = Vec3::Zero();
  double diagonal_ = 0;
  double turn_ = 1;  // of normals, where they are given inwards
  std::vector<View> views_;
  std::vector<Ball> patches_;
};

}  // namespace

ScannedCloud scan_surface(const SurfaceMesh& surface, const ScannerOptions& options) {
  return Scanner(surface, options).run();
}

}  // namespace scan2fea
