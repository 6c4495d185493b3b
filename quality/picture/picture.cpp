#include "quality/picture/picture.hpp"

#include "quality/picture/png.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace scan2fea {
namespace {

// Each pixel is the mean of so many samples along both axes.
constexpr std::uint32_t samples = 2;

struct Sample {
  float depth = std::numeric_limits<float>::infinity();
  std::array<std::uint8_t, 3> colour{};
};

// Picture coordinates: x to the right and y down in samples, z away from the eye in model units.
class Projection {
 public:
  Projection(const PictureView& view, std::uint32_t width, std::uint32_t height)
      : centre_(view.centre),
        away_(view.towards),
        right_(away_.cross(view.up).normalized()),
        up_(right_.cross(away_)),
        scale_(height / view.height),
        middle_(0.5 * width, 0.5 * height, 0) {}

  Vec3 operator()(const Vec3& p) const {
    const Vec3 d = p - centre_;
    return middle_ + Vec3(scale_ * right_.dot(d), -scale_ * up_.dot(d), away_.dot(d));
  }
  double brightness(const Vec3& normal) const {
    // The rest comes from the eye's left shoulder: not far above it, or what is seen from below would be black.
    constexpr double ambient = 0.45;
    const Vec3 light = (0.5 * up_ - 2 * away_ - 0.5 * right_).normalized();
    constexpr double of_backs = 0.6;
    const bool is_back = normal.dot(away_) > 0;
    const Vec3 facing = is_back ? Vec3(-normal) : normal;
    return (is_back ? of_backs : 1) * (ambient + (1 - ambient) * std::max(0.0, facing.dot(light)));
  }

 private:
  Vec3 centre_, away_, right_, up_;
  double scale_;
  Vec3 middle_;
};

class Canvas {
 public:
  Canvas(std::uint32_t width, std::uint32_t height)
      : width_(width), height_(height), samples_(static_cast<std::size_t>(width) * height) {}

  // `edges`: samples that are nearer than this to the side across from a corner are dark. `beyond`: how far each corner
  // is beyond a cut, if there is one.
  void fill(const std::array<Vec3, 3>& p, const Rgb& colour, double brightness, const std::array<double, 3>& edges,
            double nearest, const std::optional<Vec3>& beyond) {
    const double area = (p[1] - p[0]).head<2>().x() * (p[2] - p[0]).y() - (p[1] - p[0]).y() * (p[2] - p[0]).x();
    if (!(std::abs(area) > 0)) return;
    const auto [left, right] = std::minmax({p[0].x(), p[1].x(), p[2].x()});
    const auto [top, bottom] = std::minmax({p[0].y(), p[1].y(), p[2].y()});
    if (right < 0 || bottom < 0 || left >= width_ || top >= height_) return;
    const auto from = [](double low) { return static_cast<std::uint32_t>(std::max(0.0, std::floor(low))); };
    const auto to = [](double high, std::uint32_t size) {
      return static_cast<std::uint32_t>(std::min(static_cast<double>(size), std::ceil(high) + 1));
    };
    std::array<double, 3> height;  // of each corner over its side, samples
    for (std::size_t k = 0; k < 3; ++k) height[k] = std::abs(area) / (p[(k + 2) % 3] - p[(k + 1) % 3]).head<2>().norm();
    for (std::uint32_t y = from(top); y < to(bottom, height_); ++y)
      for (std::uint32_t x = from(left); x < to(right, width_); ++x) {
        const Vec3 at(x + 0.5, y + 0.5, 0);
        std::array<double, 3> b;
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3 u = p[(k + 1) % 3] - at, v = p[(k + 2) % 3] - at;
          b[k] = (u.x() * v.y() - u.y() * v.x()) / area;
        }
        if (b[0] < 0 || b[1] < 0 || b[2] < 0) continue;
        if (beyond && Vec3(b[0], b[1], b[2]).dot(*beyond) > 0) continue;
        const auto depth = static_cast<float>(b[0] * p[0].z() + b[1] * p[1].z() + b[2] * p[2].z());
        Sample& sample = samples_[static_cast<std::size_t>(y) * width_ + x];
        if (!(depth < sample.depth) || depth < nearest) continue;
        const bool is_edge = b[0] * height[0] < edges[0] || b[1] * height[1] < edges[1] || b[2] * height[2] < edges[2];
        sample.depth = depth;
        for (std::size_t c = 0; c < 3; ++c)
          sample.colour[c] = static_cast<std::uint8_t>(colour[c] * brightness * (is_edge ? 0.6 : 1.0));
      }
  }

  void draw_ring(const Vec3& centre, double radius, double thickness) {
    for (std::uint32_t y = 0; y < height_; ++y)
      for (std::uint32_t x = 0; x < width_; ++x) {
        const double off = std::abs(std::hypot(x + 0.5 - centre.x(), y + 0.5 - centre.y()) - radius);
        if (off > thickness) continue;
        samples_[static_cast<std::size_t>(y) * width_ + x] = {0, {20, 20, 20}};
      }
  }

  std::vector<std::uint8_t> rgba() const {
    std::vector<std::uint8_t> pixels;
    pixels.reserve(samples_.size() / (samples * samples) * 4);
    for (std::uint32_t y = 0; y < height_; y += samples)
      for (std::uint32_t x = 0; x < width_; x += samples) {
        std::array<unsigned, 3> sum{};
        unsigned covered = 0;
        for (std::uint32_t k = 0; k < samples * samples; ++k) {
          const Sample& sample = samples_[static_cast<std::size_t>(y + k / samples) * width_ + x + k % samples];
          if (std::isinf(sample.depth)) continue;
          ++covered;
          for (std::size_t c = 0; c < 3; ++c) sum[c] += sample.colour[c];
        }
        for (const unsigned channel : sum) pixels.push_back(static_cast<std::uint8_t>(covered ? channel / covered : 0));
        pixels.push_back(static_cast<std::uint8_t>(255 * covered / (samples * samples)));
      }
    return pixels;
  }

 private:
  std::uint32_t width_, height_;
  std::vector<Sample> samples_;
};

}  // namespace

PictureView view_of_all(const SurfaceMesh& mesh, const Vec3& towards, const Vec3& up, double aspect) {
  constexpr double room = 1.06;
  const Vec3 away = towards.normalized(), right = away.cross(up).normalized(), above = right.cross(away);
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : mesh.vertices) {
    const Vec3 q(right.dot(p), above.dot(p), away.dot(p));
    low = low.cwiseMin(q), high = high.cwiseMax(q);
  }
  const Vec3 middle = 0.5 * (low + high), size = high - low;
  return {.towards = away,
          .up = up,
          .centre = middle.x() * right + middle.y() * above + middle.z() * away,
          .height = room * std::max({size.y(), size.x() / aspect, std::numeric_limits<double>::min()})};
}

Raster draw_raster(const SurfaceMesh& mesh, std::span<const Rgb> colours, const PictureView& view,
                   const PictureOptions& options) {
  const std::uint32_t width = samples * options.width, height = samples * options.height;
  const Projection project(view, width, height);
  Canvas canvas(width, height);
  const double nearest = view.nearest ? -*view.nearest : -std::numeric_limits<double>::infinity();
  constexpr double edge = 1;  // sample
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    const double brightness = project.brightness(area_vector(mesh, t).stableNormalized());
    const std::array<Vec3, 3> corners{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    std::array<double, 3> edges{};
    for (std::size_t k = 0; k < 3; ++k)
      if (options.edges && (options.sides.empty() || options.sides[f][k])) edges[k] = edge;
    std::optional<Vec3> beyond;
    if (view.cut) {
      const auto [a, b, c] = corners;
      const Vec3& normal = view.cut->normal;
      beyond = Vec3(normal.dot(a), normal.dot(b), normal.dot(c)).array() - view.cut->offset;
    }
    canvas.fill({project(corners[0]), project(corners[1]), project(corners[2])}, colours[f], brightness, edges, nearest,
                beyond);
  }
  if (options.ring) canvas.draw_ring(project(*options.ring), 0.06 * height, 1.5);
  return {.width = options.width, .height = options.height, .rgba = canvas.rgba()};
}

std::string draw_picture(const SurfaceMesh& mesh, std::span<const Rgb> colours, const PictureView& view,
                         const PictureOptions& options) {
  const Raster raster = draw_raster(mesh, colours, view, options);
  return png(raster.width, raster.height, raster.rgba);
}

}  // namespace scan2fea
