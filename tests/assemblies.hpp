// Assemblies of two bodies and more that touch in many ways, each body tessellated on its own.
#pragma once

#include "tests/touching_bodies.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace scan2fea::analytic {

struct Assembly {
  std::string name;
  std::vector<Body> bodies;
  JoinOptions joining = {};
};

inline SurfaceMesh mapped(SurfaceMesh mesh, const std::function<Vec3(const Vec3&)>& map) {
  for (Vec3& p : mesh.vertices) p = map(p);
  return mesh;
}

inline SurfaceMesh box_at(const Vec3& size, double edge, const Vec3& at) {
  return moved(box(size, edge), at);
}

// Points of a polygon in the half plane of radius and height.
using Profile = std::vector<std::array<double, 2>>;

// With points on its sides, `edge` apart; closed: from the last point to the first, too.
inline Profile divided(const Profile& profile, double edge, bool closed) {
  Profile points;
  for (std::size_t i = 0; i + (closed ? 0 : 1) < profile.size(); ++i) {
    const auto &a = profile[i], &b = profile[(i + 1) % profile.size()];
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::hypot(b[0] - a[0], b[1] - a[1]) / edge)));
    for (int k = 0; k < pieces; ++k)
      points.push_back({a[0] + (b[0] - a[0]) * k / pieces, a[1] + (b[1] - a[1]) * k / pieces});
  }
  if (!closed) points.push_back(profile.back());
  return points;
}

inline Profile arc(double radius, double z, double around, double from_deg, double to_deg, int pieces) {
  Profile points;
  for (int k = 0; k <= pieces; ++k) {
    const double angle = (from_deg + (to_deg - from_deg) * k / pieces) * std::numbers::pi / 180;
    const double r = radius + around * std::cos(angle);
    points.push_back({r < 1e-9 ? 0 : r, z + around * std::sin(angle)});
  }
  return points;
}

// The second profile goes on where the first one ends.
inline Profile joined(Profile first, const Profile& second) {
  first.insert(first.end(), second.begin() + 1, second.end());
  return first;
}

// Turned about z, with so many sides: from the axis to the axis, or around a ring.
inline SurfaceMesh revolved(const Profile& profile, int around, double phase = 0) {
  SurfaceMesh mesh;
  std::vector<std::vector<std::uint32_t>> rows;
  for (const auto& [r, z] : profile) {
    std::vector<std::uint32_t>& row = rows.emplace_back();
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around + phase;
      if (r > 0 || i == 0) mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
      row.push_back(static_cast<std::uint32_t>(mesh.vertices.size() - 1));
    }
  }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
  };
  const bool on_axis = profile.front()[0] == 0;
  for (std::size_t k = 0; k + (on_axis ? 1 : 0) < rows.size(); ++k)
    for (std::size_t i = 0; i < rows[k].size(); ++i) {
      const std::size_t j = (i + 1) % rows[k].size(), next = (k + 1) % rows.size();
      add(rows[k][i], rows[k][j], rows[next][j]);
      add(rows[k][i], rows[next][j], rows[next][i]);
    }
  return enclosed_volume(mesh) < 0 ? reversed(mesh) : mesh;
}

inline SurfaceMesh unit_voxels(const std::array<int, 3>& counts, const std::function<bool(const Vec3&)>& is_in) {
  return voxels(counts, {1, 1, 1}, is_in);
}

inline std::vector<Assembly> plane_assemblies() {
  const SurfaceMesh notched =
      unit_voxels({10, 10, 10}, [](const Vec3& p) { return !(p.x() > 5 && p.y() > 5 && p.z() > 5); });
  const SurfaceMesh slotted =
      unit_voxels({20, 12, 8}, [](const Vec3& p) { return std::abs(p.y() - 6) > 2 || p.z() < 4; });
  const auto tilted = [](double z0) {
    return [z0](const Vec3& p) {
      return Vec3(p.x(), p.y(), z0 * (1 + 0.05 * p.x()) + p.z() * (z0 > 0 ? 1 : 1 + 0.05 * p.x()));
    };
  };
  return {
      {"cube in a notch", {{"BLOCK", notched}, {"CUBE", box_at({5, 5, 5}, 0.9, {5, 5, 5})}}},
      {"large cube in a notch", {{"BLOCK", notched}, {"CUBE", box_at({8, 8, 8}, 1.1, {5, 5, 5})}}},
      {"key in its slot", {{"SLOT", slotted}, {"KEY", box_at({14, 4, 6}, 1.3, {3, 4, 4})}}},
      {"long key", {{"KEY", box_at({26, 4, 6}, 1.3, {-3, 4, 4})}, {"SLOT", slotted}}},
      {"four around a line",
       {{"A", box_at({4, 4, 3}, 1, {0, 0, 0})},
        {"B", box_at({4, 4, 3}, 0.8, {4, 0, 0})},
        {"C", box_at({4, 4, 3}, 0.9, {0, 4, 0})},
        {"D", box_at({4, 4, 3}, 1.2, {4, 4, 0})}}},
      {"small on large", {{"PLATE", box_at({40, 40, 3}, 4, {0, 0, 0})}, {"BUMP", box_at({1, 1, 1}, 0.3, {20, 20, 3})}}},
      {"three plates",
       {{"A", box_at({20, 10, 1}, 1, {0, 0, 0})},
        {"B", box_at({20, 10, 0.3}, 1.5, {0, 0, 1})},
        {"C", box_at({20, 10, 1}, 2, {0, 0, 1.3})}}},
      {"wedges", {{"A", mapped(box({10, 6, 4}, 1), tilted(0))}, {"B", mapped(box({10, 6, 4}, 0.8), tilted(4))}}},
      {"pile of five",
       {{"A", box_at({12, 8, 2}, 1, {0, 0, 0})},
        {"B", box_at({4, 6, 3}, 0.9, {1, 1, 2})},
        {"C", box_at({4, 6, 3}, 0.8, {7, 1, 2})},
        {"D", box_at({12, 5, 1.5}, 1.1, {0, 1.5, 5})},
        {"E", box_at({2, 2, 3}, 0.7, {5, 3, 2})}}},
      {"noisy blocks",
       {{"A", noisy(box_at({10, 8, 4}, 0.35, {0, 0, 0}), 0.004, 1)},
        {"B", noisy(box_at({6, 5, 4}, 0.3, {2, 1.5, 4}), 0.004, 2)}},
       {.tolerance = 0.05}},
  };
}

inline std::vector<Assembly> round_assemblies() {
  const SurfaceMesh bracket = bored_block({30, 20, 10}, 5, 96, 4);
  const SurfaceMesh plate = box_at({20, 20, 3}, 1, {-10, -10, -3});
  const SurfaceMesh shaft = revolved(divided({{0, -6}, {4, -6}, {4, 5}, {7, 5}, {7, 14}, {0, 14}}, 1.3, false), 90);
  const SurfaceMesh hub = revolved(divided({{4, 0}, {12, 0}, {12, 10}, {7, 10}, {7, 5}, {4, 5}}, 1.1, true), 110, 0.01);
  const SurfaceMesh puck = revolved(joined(joined(divided({{0, 0}, {3, 0}}, 0.5, false), arc(3, 1, 1, -90, 0, 10)),
                                           divided({{4, 1}, {4, 8}, {0, 8}}, 0.6, false)),
                                    64);
  const SurfaceMesh socket =
      revolved(joined(arc(0, 0, 5, -90, 0, 30), divided({{5, 0}, {9, 0}, {9, -8}, {0, -8}}, 0.8, false)), 90);
  const Profile half = joined(divided({{0, 0}, {6, 0}}, 0.7, false), arc(0, 0, 6, 0, 90, 24));
  const auto upside_down = [](const Vec3& p) { return Vec3(p.x(), -p.y(), -p.z()); };
  const auto pin = [](double radius, double height, int around, double z) {
    return moved(cylinder(radius, height, around, 8), {0, 0, z});
  };
  return {
      {"pin", {{"BRACKET", bracket}, {"PIN", pin(5, 24, 80, -7)}}},
      {"pin in two", {{"A", bracket}, {"B", moved(bracket, {0, 0, 10})}, {"PIN", pin(5, 30, 80, -5)}}},
      {"fine pin", {{"BRACKET", bored_block({30, 20, 10}, 5, 256, 30)}, {"PIN", pin(5, 24, 200, -7)}}},
      {"pressed pin", {{"BRACKET", bracket}, {"PIN", pin(5.02, 24, 80, -7)}}, {.tolerance = 0.06}},
      {"loose pin", {{"BRACKET", bracket}, {"PIN", pin(4.98, 24, 80, -7)}}, {.tolerance = 0.06}},
      {"noisy pin",
       {{"BRACKET", noisy(bored_block({30, 20, 10}, 5, 96, 20), 0.005, 1)},
        {"PIN", noisy(moved(cylinder(5, 24, 80, 40), {0, 0, -7}), 0.005, 2)}},
       {.tolerance = 0.05}},
      {"polygons of 24 and 16",
       {{"BRACKET", bored_block({30, 20, 10}, 5, 24, 1)}, {"PIN", moved(cylinder(5, 24, 16, 1), {0, 0, -7})}}},
      {"liner",
       {{"BRACKET", bracket}, {"LINER", revolved(divided({{4.2, -1}, {5, -1}, {5, 11}, {4.2, 11}}, 1, true), 80)}}},
      {"pin in a liner",
       {{"BRACKET", bracket},
        {"LINER", revolved(divided({{4, 0}, {5, 0}, {5, 10}, {4, 10}}, 1, true), 80)},
        {"PIN", moved(cylinder(4, 14, 70, 6), {0, 0, -2})}}},
      {"shaft in its hub", {{"HUB", hub}, {"SHAFT", shaft}}},
      {"hub on its shaft", {{"SHAFT", shaft}, {"HUB", hub}}},
      {"disk on a plate", {{"PLATE", plate}, {"DISK", cylinder(6, 2, 60, 1)}}},
      {"chamfered rod on a plate",
       {{"PLATE", plate}, {"ROD", revolved(divided({{0, 0}, {3, 0}, {4, 1}, {4, 12}, {0, 12}}, 1, false), 64)}}},
      {"rounded puck on a plate", {{"PLATE", plate}, {"PUCK", puck}}},
      {"ball in its socket", {{"SOCKET", socket}, {"BALL", sphere(5, 4)}}},
      {"cone in its seat",
       {{"SEAT", revolved(divided({{2, 0}, {8, 0}, {8, 6}, {4, 6}}, 0.7, true), 90, 0.02)},
        {"PLUG", revolved(divided({{0, 0}, {2, 0}, {4, 6}, {4, 9}, {0, 9}}, 0.6, false), 70)}}},
      {"halves of a ball", {{"UPPER", revolved(half, 60)}, {"LOWER", mapped(revolved(half, 72), upside_down)}}},
      {"three shells",
       {{"A", join(sphere(10, 5), reversed(sphere(8, 5)))},
        {"B",
         join(mapped(sphere(8, 5), [](const Vec3& p) { return Vec3(p.y(), p.z(), p.x()); }), reversed(sphere(6, 4)))},
        {"C", sphere(6, 4)}}},
  };
}

// With a wavy surface between, of the large block or of a smaller one on it.
inline std::vector<Assembly> wavy_assemblies() {
  const auto wave = [](const Vec3& p) { return 0.4 * std::sin(0.8 * p.x()) * std::cos(0.6 * p.y()); };
  const auto below = [&](const Vec3& p) { return Vec3(p.x(), p.y(), p.z() + p.z() / 4 * wave(p)); };
  const auto above = [&](const Vec3& p) { return Vec3(p.x(), p.y(), p.z() + (8 - p.z()) / 4 * wave(p)); };
  const SurfaceMesh base = mapped(box({10, 8, 4}, 0.25), below);
  return {{"wavy blocks", {{"A", base}, {"B", mapped(box_at({10, 8, 4}, 0.3, {0, 0, 4}), above)}}},
          {"wavy patch", {{"A", base}, {"B", mapped(box_at({6, 5, 4}, 0.3, {2, 1.5, 4}), above)}}}};
}

}  // namespace scan2fea::analytic
