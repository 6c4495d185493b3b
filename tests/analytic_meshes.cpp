#include "tests/analytic_meshes.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace scan2fea::analytic {
namespace {

using Cell = std::array<int, 3>;

// The boundary of a set of grid cells, vertices shared.
class CellSurface {
 public:
  explicit CellSurface(const Vec3& spacing) : spacing_(spacing) {}

  void quad(const Cell& a, const Cell& b, const Cell& c, const Cell& d) {
    const std::uint32_t i = vertex(a), j = vertex(b), k = vertex(c), l = vertex(d);
    mesh_.triangles.push_back({i, j, k});
    mesh_.triangles.push_back({i, k, l});
  }

  SurfaceMesh take() { return std::move(mesh_); }

 private:
  std::uint32_t vertex(const Cell& cell) {
    const auto [it, added] = index_.try_emplace(cell, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (added) mesh_.vertices.emplace_back(Vec3(cell[0], cell[1], cell[2]).cwiseProduct(spacing_));
    return it->second;
  }

  Vec3 spacing_;
  std::map<Cell, std::uint32_t> index_;
  SurfaceMesh mesh_;
};

template <class Inside>
SurfaceMesh voxel_surface(const Cell& count, const Vec3& spacing, Inside inside) {
  CellSurface surface(spacing);
  const auto filled = [&](int x, int y, int z) {
    return x >= 0 && y >= 0 && z >= 0 && x < count[0] && y < count[1] && z < count[2] && inside(x, y, z);
  };
  for (int x = 0; x < count[0]; ++x)
    for (int y = 0; y < count[1]; ++y)
      for (int z = 0; z < count[2]; ++z) {
        if (!filled(x, y, z)) continue;
        const int X = x + 1, Y = y + 1, Z = z + 1;
        if (!filled(x - 1, y, z)) surface.quad({x, y, z}, {x, y, Z}, {x, Y, Z}, {x, Y, z});
        if (!filled(x + 1, y, z)) surface.quad({X, y, z}, {X, Y, z}, {X, Y, Z}, {X, y, Z});
        if (!filled(x, y - 1, z)) surface.quad({x, y, z}, {X, y, z}, {X, y, Z}, {x, y, Z});
        if (!filled(x, y + 1, z)) surface.quad({x, Y, z}, {x, Y, Z}, {X, Y, Z}, {X, Y, z});
        if (!filled(x, y, z - 1)) surface.quad({x, y, z}, {x, Y, z}, {X, Y, z}, {X, y, z});
        if (!filled(x, y, z + 1)) surface.quad({x, y, Z}, {X, y, Z}, {X, Y, Z}, {x, Y, Z});
      }
  return surface.take();
}

}  // namespace

SurfaceMesh box(const Vec3& size, double edge_length) {
  Cell count{};
  Vec3 spacing;
  for (int k = 0; k < 3; ++k) {
    const int n = std::max(1, static_cast<int>(std::lround(size[k] / edge_length)));
    count[static_cast<std::size_t>(k)] = n;
    spacing[k] = size[k] / n;
  }
  return voxel_surface(count, spacing, [](int, int, int) { return true; });
}

SurfaceMesh slab_with_holes(int genus, double edge_length) {
  const int n = std::max(1, static_cast<int>(std::lround(1 / edge_length)));
  return voxel_surface({(2 * genus + 1) * n, 3 * n, n}, Vec3::Constant(1.0 / n),
                       [n](int x, int y, int) { return (x / n) % 2 == 0 || (y / n) != 1; });
}

SurfaceMesh block_with_fin(double edge_length) {
  return voxel_surface({24, 8, 10}, edge_length * Vec3(1, 1, 0.625), [](int x, int, int z) { return z == 0 || x < 6; });
}

SurfaceMesh plate(const Vec3& size, double edge_length) {
  const auto columns = static_cast<std::uint32_t>(std::round(size.x() / edge_length));
  const auto rows = static_cast<std::uint32_t>(std::round(size.y() / (edge_length * std::numbers::sqrt3 / 2)));
  SurfaceMesh mesh;
  const auto at = [&](std::uint32_t i, std::uint32_t row, std::uint32_t level) {
    return (level * (rows + 1) + row) * (columns + 1) + i;
  };
  const auto leans_right = [](std::uint32_t row, std::uint32_t level) { return (row + level) % 2 == 0; };
  for (std::uint32_t level = 0; level < 2; ++level)
    for (std::uint32_t row = 0; row <= rows; ++row)
      for (std::uint32_t i = 0; i <= columns; ++i) {
        const double shift = i == 0 || i == columns ? 0 : leans_right(row, level) ? 0.25 : -0.25;
        mesh.vertices.emplace_back(size.x() * (i + shift) / columns, size.y() * row / rows, size.z() * level);
      }
  // Between two rows, the first below the second as seen from outside with its indices from left to right.
  const auto cell = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d, bool from_a) {
    if (from_a)
      mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {a, d, c}});
    else
      mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {b, d, c}});
  };
  for (std::uint32_t i = 0; i < columns; ++i) {
    for (std::uint32_t row = 0; row < rows; ++row) {
      cell(at(i, row, 1), at(i + 1, row, 1), at(i, row + 1, 1), at(i + 1, row + 1, 1), leans_right(row, 1));
      cell(at(i, row + 1, 0), at(i + 1, row + 1, 0), at(i, row, 0), at(i + 1, row, 0), leans_right(row + 1, 0));
    }
    cell(at(i, 0, 0), at(i + 1, 0, 0), at(i, 0, 1), at(i + 1, 0, 1), leans_right(0, 0));
    cell(at(i, rows, 1), at(i + 1, rows, 1), at(i, rows, 0), at(i + 1, rows, 0), leans_right(rows, 1));
  }
  for (std::uint32_t row = 0; row < rows; ++row) {
    cell(at(columns, row, 0), at(columns, row + 1, 0), at(columns, row, 1), at(columns, row + 1, 1), row % 2 == 0);
    cell(at(0, row, 1), at(0, row + 1, 1), at(0, row, 0), at(0, row + 1, 0), row % 2 == 0);
  }
  return mesh;
}

SurfaceMesh sphere(double radius, int levels) {
  const double g = std::numbers::phi;
  SurfaceMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, added] = middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (added) mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      return it->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
    for (Vec3& v : mesh.vertices) v.normalize();
  }
  for (Vec3& v : mesh.vertices) v = radius * v.normalized();
  return mesh;
}

SurfaceMesh torus(double major_radius, double minor_radius, int around, int across) {
  SurfaceMesh mesh;
  const auto index = [&](int i, int j) { return static_cast<std::uint32_t>((i % around) * across + (j % across)); };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double r = major_radius + minor_radius * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), minor_radius * std::sin(v));
      mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
      mesh.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  return mesh;
}

SurfaceMesh cylinder(double radius, double height, int around, int along) {
  SurfaceMesh mesh;
  const auto n = static_cast<std::uint32_t>(around);
  for (int k = 0; k <= along; ++k)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height * k / along);
    }
  const auto bottom = static_cast<std::uint32_t>(mesh.vertices.size()), top = bottom + 1;
  mesh.vertices.emplace_back(0, 0, 0);
  mesh.vertices.emplace_back(0, 0, height);
  const std::uint32_t last = n * static_cast<std::uint32_t>(along);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({bottom, j, i});
    mesh.triangles.push_back({top, last + i, last + j});
    for (std::uint32_t k = 0; k < last; k += n) {
      mesh.triangles.push_back({k + i, k + j, k + n + j});
      mesh.triangles.push_back({k + i, k + n + j, k + n + i});
    }
  }
  return mesh;
}

SurfaceMesh pipe(double inner, double outer, double length, int around) {
  const double side = 2 * std::numbers::pi * outer / around;
  const int along = std::max(1, static_cast<int>(std::lround(length / side)));
  const int across = std::max(1, static_cast<int>(std::lround((outer - inner) / side)));
  // Rings up the outer wall, over the upper end, down the bore, and over the lower end: their radii and heights.
  std::vector<std::array<double, 2>> rings;
  for (int i = 0; i < along; ++i) rings.push_back({outer, length * i / along});
  for (int i = 0; i < across; ++i) rings.push_back({outer + (inner - outer) * i / across, length});
  for (int i = 0; i < along; ++i) rings.push_back({inner, length - length * i / along});
  for (int i = 0; i < across; ++i) rings.push_back({inner + (outer - inner) * i / across, 0});
  SurfaceMesh mesh;
  const auto index = [&](std::size_t ring, int i) {
    return static_cast<std::uint32_t>(ring % rings.size() * static_cast<std::size_t>(around) +
                                      static_cast<std::size_t>(i % around));
  };
  for (std::size_t ring = 0; ring < rings.size(); ++ring)
    for (int i = 0; i < around; ++i) {
      const auto& [radius, height] = rings[ring];
      const double angle = 2 * std::numbers::pi * i / around;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), height);
      mesh.triangles.push_back({index(ring, i), index(ring, i + 1), index(ring + 1, i + 1)});
      mesh.triangles.push_back({index(ring, i), index(ring + 1, i + 1), index(ring + 1, i)});
    }
  return mesh;
}

SurfaceMesh lens(double rim_angle_deg, int around, int rings) {
  const double half = rim_angle_deg / 2 * std::numbers::pi / 180;
  const double radius = 1 / std::sin(half), centre = 1 / std::tan(half);
  const auto n = static_cast<std::uint32_t>(around);
  SurfaceMesh mesh;
  const auto add_ring = [&](int ring, double side) {
    const double r = 1 - static_cast<double>(ring) / rings, z = std::sqrt(radius * radius - r * r) - centre;
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * std::numbers::pi * (i + ring / 2.0) / around;
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), side * z);
    }
  };
  add_ring(0, 1);
  for (const double side : {1.0, -1.0}) {
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh.triangles.push_back(side > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
    };
    std::uint32_t outer = 0;
    for (int ring = 1; ring < rings; ++ring) {
      const auto inner = static_cast<std::uint32_t>(mesh.vertices.size());
      add_ring(ring, side);
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        add(outer + i, outer + j, inner + i);
        add(outer + j, inner + j, inner + i);
      }
      outer = inner;
    }
    const auto pole = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.emplace_back(0, 0, side * (radius - centre));
    for (std::uint32_t i = 0; i < n; ++i) add(outer + i, outer + (i + 1) % n, pole);
  }
  return mesh;
}

SurfaceMesh sheet(double width, double depth, double edge_length) {
  const auto n = static_cast<std::uint32_t>(std::max(1L, std::lround(width / edge_length)));
  const auto m = static_cast<std::uint32_t>(std::max(1L, std::lround(depth / edge_length)));
  SurfaceMesh mesh;
  for (std::uint32_t j = 0; j <= m; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) mesh.vertices.emplace_back(width * i / n, depth * j / m, 0);
  for (std::uint32_t j = 0; j < m; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, d = a + n + 1, c = d + 1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

SurfaceMesh voxels(const std::array<int, 3>& counts, const Vec3& size,
                   const std::function<bool(const Vec3& centre)>& is_in) {
  return voxel_surface(counts, size,
                       [&](int x, int y, int z) { return is_in(size.cwiseProduct(Vec3(x + 0.5, y + 0.5, z + 0.5))); });
}

SurfaceMesh voxel_ball(int across) {
  const double radius = across / 2.0;
  return voxels({across, across, across}, Vec3::Ones(),
                [&](const Vec3& p) { return (p - Vec3::Constant(radius)).norm() < radius; });
}

SurfaceMesh join(const SurfaceMesh& a, const SurfaceMesh& b) {
  SurfaceMesh both = a;
  append(both, b);
  return both;
}

SurfaceMesh moved(SurfaceMesh mesh, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v += by;
  return mesh;
}

SurfaceMesh reversed(SurfaceMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

SurfaceMesh elsewhere(const SurfaceMesh& mesh, unsigned seed, double turned_triangles) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> one(-1, 1);
  const Vec3 axis = Vec3(one(random), one(random), one(random)).normalized();
  const Eigen::AngleAxisd turn(3 * one(random), axis);
  const Vec3 by = 3 * bounding_box(mesh.vertices).diagonal() * Vec3(one(random), one(random), one(random));

  std::vector<std::uint32_t> place(mesh.vertices.size());
  std::iota(place.begin(), place.end(), 0U);
  std::shuffle(place.begin(), place.end(), random);
  SurfaceMesh other{std::vector<Vec3>(mesh.vertices.size()), mesh.triangles};
  for (std::size_t v = 0; v < place.size(); ++v) other.vertices[place[v]] = turn * mesh.vertices[v] + by;
  std::shuffle(other.triangles.begin(), other.triangles.end(), random);
  for (Triangle& t : other.triangles) {
    for (std::uint32_t& v : t) v = place[v];
    std::rotate(t.begin(), t.begin() + std::uniform_int_distribution<int>(0, 2)(random), t.end());
    if (std::abs(one(random)) < turned_triangles) std::swap(t[0], t[1]);
  }
  return other;
}

SurfaceMesh noisy(SurfaceMesh mesh, double sigma, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise;  // not of `sigma`, which may be zero here and may not there
  for (Vec3& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) v[k] += sigma * noise(generator);
  return mesh;
}

}  // namespace scan2fea::analytic
