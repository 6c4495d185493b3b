// Bodies that touch, each tessellated on its own.
#pragma once

#include "preproc/bodies/body_complex.hpp"
#include "tests/analytic_meshes.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace scan2fea::analytic {

// A block around the origin, from z = 0 up, with a bore of so many sides about z through it; walls in `along` rings.
inline SurfaceMesh bored_block(const Vec3& size, double radius, int around, int along) {
  SurfaceMesh mesh;
  const auto vertex = [&](double x, double y, double z) {
    mesh.vertices.emplace_back(x, y, z);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  // Rays from the axis to the corners and through the bore's vertices, which are at other angles.
  std::vector<double> angles;
  for (int i = 0; i < around; ++i) angles.push_back(2 * std::numbers::pi * (i + 0.5) / around);
  std::vector<std::vector<std::uint32_t>> bore, wall;
  const auto on_wall = [&](double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const double scale = std::min(size.x() / 2 / std::abs(c), size.y() / 2 / std::abs(s));
    return Vec3(scale * c, scale * s, 0);
  };
  std::vector<Vec3> rim;  // of the wall, with its corners
  std::vector<bool> is_corner;
  const double corner = std::atan2(size.y(), size.x());
  for (int i = 0; i < around; ++i) {
    rim.push_back(on_wall(angles[static_cast<std::size_t>(i)]));
    is_corner.push_back(false);
    const double next = 2 * std::numbers::pi * (i + 1.5) / around;
    for (const double at : {corner, std::numbers::pi - corner, std::numbers::pi + corner, 2 * std::numbers::pi - corner,
                            2 * std::numbers::pi + corner})
      if (at > angles[static_cast<std::size_t>(i)] + 1e-9 && at < next - 1e-9) {
        rim.push_back(on_wall(at));
        is_corner.push_back(true);
      }
  }
  for (int k = 0; k <= along; ++k) {
    const double z = size.z() * k / along;
    bore.emplace_back();
    wall.emplace_back();
    for (const double a : angles) bore.back().push_back(vertex(radius * std::cos(a), radius * std::sin(a), z));
    for (const Vec3& p : rim) wall.back().push_back(vertex(p.x(), p.y(), z));
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  const std::size_t n = bore[0].size(), m = rim.size();
  for (std::size_t k = 0; k < static_cast<std::size_t>(along); ++k) {
    for (std::size_t i = 0; i < n; ++i)
      quad(bore[k][(i + 1) % n], bore[k][i], bore[k + 1][i], bore[k + 1][(i + 1) % n]);
    for (std::size_t i = 0; i < m; ++i)
      quad(wall[k][i], wall[k][(i + 1) % m], wall[k + 1][(i + 1) % m], wall[k + 1][i]);
  }
  for (const bool top : {false, true}) {
    const auto& inner = top ? bore.back() : bore.front();
    const auto& outer = top ? wall.back() : wall.front();
    const auto face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh.triangles.push_back(top ? Triangle{a, b, c} : Triangle{a, c, b});
    };
    std::size_t i = 0;  // of the bore
    for (std::size_t j = 0; j < m; ++j) {
      face(outer[j], outer[(j + 1) % m], inner[i % n]);
      if (is_corner[(j + 1) % m]) continue;
      face(outer[(j + 1) % m], inner[(i + 1) % n], inner[i % n]);
      ++i;
    }
  }
  return mesh;
}

// The corners of one mesh, in numbers: edges whose triangles are not two that go opposite ways.
inline std::size_t open_edges(const std::vector<Triangle>& triangles) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
  std::size_t open = 0;
  std::sort(edges.begin(), edges.end());
  for (const auto& [a, b] : edges) {
    const auto [own, own_end] = std::equal_range(edges.begin(), edges.end(), std::array{a, b});
    const auto [back, back_end] = std::equal_range(edges.begin(), edges.end(), std::array{b, a});
    open += own_end - own != 1 || back_end - back != 1;
  }
  return open;
}

}  // namespace scan2fea::analytic
