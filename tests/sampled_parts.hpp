// Point clouds of parts that are known by their drawing: jittered points with normals, reproducible by seed.
#pragma once

#include "preproc/mesh/surface_mesh.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace scan2fea {

class SampledPart {
 public:
  // `spacing` between points; `sigma` of Gaussian noise along normals.
  SampledPart(double spacing, double sigma, unsigned seed) : spacing_(spacing), sigma_(sigma), random_(seed) {}

  std::vector<Vec3> points;
  std::vector<Vec3> outwards;

  using Keep = std::function<bool(const Vec3&)>;

  // The parallelogram from `corner` along u and v; its normal is u x v.
  void add_plane(const Vec3& corner, const Vec3& u, const Vec3& v, const Keep& keep = everything) {
    const Vec3 normal = u.cross(v).normalized();
    add_grid(u.norm(), v.norm(), [&](double s, double t) {
      const Vec3 p = corner + s * u.normalized() + t * v.normalized();
      if (keep(p)) add(p, normal);
    });
  }

  // About `axis` through `base`, from there on; angles in degrees from `zero`, a direction square to the axis. Radii at
  // the base and at the end: a cone where they differ.
  void add_cone(const Vec3& base, const Vec3& axis, double height, double first, double last, bool hollow,
                const Vec3& zero, double from_deg = 0, double to_deg = 360, const Keep& keep = everything) {
    const Vec3 side = axis.cross(zero);
    const double slant = std::atan2(first - last, height), arc = (to_deg - from_deg) * std::numbers::pi / 180;
    const double length = std::hypot(height, first - last), mean = 0.5 * (first + last);
    add_grid(length, arc * mean, [&](double s, double t) {
      const double angle = from_deg * std::numbers::pi / 180 + t / mean, share = s / length;
      const Vec3 out = std::cos(angle) * zero + std::sin(angle) * side;
      const Vec3 p = base + share * height * axis + (first + share * (last - first)) * out;
      const Vec3 normal = std::cos(slant) * out + std::sin(slant) * axis;
      if (keep(p)) add(p, hollow ? Vec3(-normal) : normal);
    });
  }

  // About `axis`; the tube from one angle to the other, 0 away from the axis, 90 degrees along it.
  void add_torus(const Vec3& centre, const Vec3& axis, double radius, double tube, bool hollow, double from_deg = 0,
                 double to_deg = 360) {
    const Vec3 x = axis.unitOrthogonal(), y = axis.cross(x);
    const double arc = (to_deg - from_deg) * std::numbers::pi / 180;
    add_grid(2 * std::numbers::pi * radius, arc * tube, [&](double s, double t) {
      const double angle = from_deg * std::numbers::pi / 180 + t / tube;
      const Vec3 out = std::cos(s / radius) * x + std::sin(s / radius) * y;
      const Vec3 normal = std::cos(angle) * out + std::sin(angle) * axis;
      add(centre + radius * out + tube * normal, hollow ? Vec3(-normal) : normal);
    });
  }

  double diagonal() const { return bounding_box(points).diagonal(); }

 private:
  static bool everything(const Vec3&) { return true; }

  void add(const Vec3& p, const Vec3& normal) {
    points.push_back(p + sigma_ * gauss_(random_) * normal);
    outwards.push_back(normal);
  }

  template <class Visit>
  void add_grid(double width, double depth, Visit visit) {
    std::uniform_real_distribution<double> jitter(0.1, 0.9);
    const int across = std::max(1, static_cast<int>(std::lround(width / spacing_)));
    const int along = std::max(1, static_cast<int>(std::lround(depth / spacing_)));
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < along; ++j) {
        const double s = (i + jitter(random_)) * width / across, t = (j + jitter(random_)) * depth / along;
        visit(s, t);
      }
  }

  double spacing_, sigma_;
  std::mt19937 random_;
  std::normal_distribution<double> gauss_;
};

// An angle of 80 x 50 x 60, 10 thick: an inner fillet of radius 6, an outer rounding of radius 8 along y, two holes of
// radius 5 in its foot. The ends are flat.
inline SampledPart angle_bracket(double spacing, double noise_of_diagonal, unsigned seed) {
  const double sigma = noise_of_diagonal * std::sqrt(80.0 * 80 + 50 * 50 + 60 * 60);
  SampledPart part(spacing, sigma, seed);
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const auto outside_holes = [](const Vec3& p) {
    return std::hypot(p[0] - 60, p[1] - 13) > 5 && std::hypot(p[0] - 60, p[1] - 37) > 5;
  };
  // Across y: inside the outline of the ends.
  const auto in_profile = [](const Vec3& p) {
    if (p[0] < 8 && p[2] < 8 && std::hypot(p[0] - 8, p[2] - 8) > 8) return false;
    if (p[0] > 10 && p[2] > 10) return p[0] < 16 && p[2] < 16 && std::hypot(p[0] - 16, p[2] - 16) > 6;
    return true;
  };
  part.add_plane({8, 0, 0}, 50 * y, 72 * x, outside_holes);    // below
  part.add_plane({16, 0, 10}, 64 * x, 50 * y, outside_holes);  // on the foot
  part.add_plane({0, 0, 8}, 52 * z, 50 * y);                   // behind
  part.add_plane({10, 0, 16}, 50 * y, 44 * z);                 // before the upright
  part.add_plane({0, 0, 60}, 10 * x, 50 * y);                  // above
  part.add_plane({80, 0, 0}, 50 * y, 10 * z);                  // in front
  part.add_plane({0, 0, 0}, 80 * x, 60 * z, in_profile);       // ends
  part.add_plane({0, 50, 0}, 60 * z, 80 * x, in_profile);
  part.add_cone({16, 0, 16}, y, 50, 6, 6, true, -x, 270, 360);  // fillet
  part.add_cone({8, 0, 8}, y, 50, 8, 8, false, -x, 270, 360);   // rounding
  for (const double at : {13.0, 37.0}) part.add_cone({60, at, 0}, z, 10, 5, 5, true, x);
  return part;
}

// A disc of radius 40 and height 12 with a hub of radius 16 and height 30, a bore of radius 8, six bolt holes of radius
// 4 at radius 30, a fillet of radius 3 around the hub and a rounding of radius 2 on its rim.
inline SampledPart flange(double spacing, double noise_of_diagonal, unsigned seed) {
  SampledPart part(spacing, noise_of_diagonal * std::sqrt(2 * 80.0 * 80 + 30 * 30), seed);
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const auto solid = [](double least, double most) {
    return [=](const Vec3& p) {
      const double r = std::hypot(p[0], p[1]);
      if (r < least || r > most) return false;
      for (int i = 0; i < 6; ++i) {
        const double angle = i * std::numbers::pi / 3;
        if (std::hypot(p[0] - 30 * std::cos(angle), p[1] - 30 * std::sin(angle)) < 4) return false;
      }
      return true;
    };
  };
  part.add_plane({-40, -40, 0}, 80 * y, 80 * x, solid(8, 40));
  part.add_plane({-40, -40, 12}, 80 * x, 80 * y, solid(19, 40));
  part.add_plane({-20, -20, 30}, 40 * x, 40 * y, solid(8, 14));
  part.add_cone(Vec3::Zero(), z, 12, 40, 40, false, x);
  part.add_cone({0, 0, 15}, z, 13, 16, 16, false, x);
  part.add_cone(Vec3::Zero(), z, 30, 8, 8, true, x);
  part.add_torus({0, 0, 15}, z, 19, 3, true, 180, 270);
  part.add_torus({0, 0, 28}, z, 14, 2, false, 0, 90);
  for (int i = 0; i < 6; ++i) {
    const double angle = i * std::numbers::pi / 3;
    part.add_cone({30 * std::cos(angle), 30 * std::sin(angle), 0}, z, 12, 4, 4, true, x);
  }
  return part;
}

// A truncated cone: radii 30 below, 15 above, height 40.
inline SampledPart frustum(double spacing, double noise_of_diagonal, unsigned seed) {
  SampledPart part(spacing, noise_of_diagonal * std::sqrt(2 * 60.0 * 60 + 40 * 40), seed);
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const auto within = [](double radius) { return [=](const Vec3& p) { return std::hypot(p[0], p[1]) < radius; }; };
  part.add_plane({-30, -30, 0}, 60 * y, 60 * x, within(30));
  part.add_plane({-15, -15, 40}, 30 * x, 30 * y, within(15));
  part.add_cone(Vec3::Zero(), z, 40, 30, 15, false, x);
  return part;
}

inline SampledPart ring(double spacing, double noise_of_diagonal, unsigned seed) {
  SampledPart part(spacing, noise_of_diagonal * std::sqrt(2 * 80.0 * 80 + 20 * 20), seed);
  part.add_torus(Vec3(1, 2, 3), Vec3(1, 2, 2) / 3, 30, 10, false);
  return part;
}

// A smooth body without a machined face.
inline SampledPart blob(int count, double noise_of_diagonal, unsigned seed) {
  SampledPart part(1, 0, seed);
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss;
  for (int i = 0; i < count; ++i) {
    // Fibonacci's spiral.
    const double z = 1 - (2.0 * i + 1) / count, angle = std::numbers::pi * (1 + std::sqrt(5.0)) * i;
    const double s = std::sqrt(1 - z * z);
    const Vec3 d(s * std::cos(angle), s * std::sin(angle), z);
    const auto radius = [](const Vec3& e) {
      return 40 * (1 + 0.18 * std::sin(3 * e[0] + 1) * std::cos(2.5 * e[1]) + 0.12 * std::sin(4 * e[2] + 2 * e[0]) +
                   0.1 * std::cos(5 * e[1] - 2 * e[2]));
    };
    part.points.push_back((radius(d) + noise_of_diagonal * 140 * gauss(random)) * d);
    part.outwards.push_back(d);
  }
  return part;
}

}  // namespace scan2fea
