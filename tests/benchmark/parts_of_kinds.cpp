// benchmark_kinds FOLDER: writes parts of the kinds on which a lattice of uniform size gives way, for
// tests/benchmark/kinds_table: thin walls, many holes, bodies far apart, thin bars, tiny fillets, engraved text, shells
// whose corners nearly meet, thorns. The name of a part is KIND-SHAPE-AMOUNT; model units are mm.
#include "preproc/mesh/write_surface.hpp"
#include "preproc/surface/sizing/split_long_edges.hpp"
#include "tests/benchmark/planar_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace scan2fea;

// An area, of one or several loops, in which a part is so high; what comes later in a list lies on top.
struct Level {
  std::vector<Loop> loops;
  double height;
};

bool is_inside(const Loop& loop, double x, double y) {
  bool inside = false;
  for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++)
    if ((loop[i].y() > y) != (loop[j].y() > y) &&
        x < (loop[j].x() - loop[i].x()) * (y - loop[i].y()) / (loop[j].y() - loop[i].y()) + loop[i].x())
      inside = !inside;
  return inside;
}

double height_at(const std::vector<Level>& levels, double x, double y) {
  double height = 0;
  for (const Level& level : levels) {
    int around = 0;
    for (const Loop& loop : level.loops) around += is_inside(loop, x, y) ? 1 : 0;
    if (around % 2 == 1) height = level.height;
  }
  return height;
}

// A body with a plane bottom and steps on top: over each triangle of the plane it has one height.
class Terrace {
 public:
  Terrace(const Region& outline, const std::vector<Level>& levels) {
    Region region = outline;
    for (const Level& level : levels) region.lines.insert(region.lines.end(), level.loops.begin(), level.loops.end());
    planar_ = triangulate(region, std::nullopt);
    for (const Triangle& t : planar_.triangles) {
      double x = 0, y = 0;
      for (const std::uint32_t v : t) {
        x += planar_.points[v].x() / 3;
        y += planar_.points[v].y() / 3;
      }
      height_.push_back(height_at(levels, x, y));
    }
  }

  SurfaceMesh mesh() {
    std::map<std::array<std::uint32_t, 2>, double> beside;  // height on the left of a directed edge
    at_vertex_.assign(planar_.points.size(), {0});
    for (std::size_t f = 0; f < height_.size(); ++f)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = planar_.triangles[f][k], b = planar_.triangles[f][(k + 1) % 3];
        beside[{a, b}] = height_[f];
        if (height_[f] > 0) at_vertex_[a].insert(height_[f]);
      }
    for (std::size_t f = 0; f < height_.size(); ++f) {
      if (!(height_[f] > 0)) continue;
      const auto& [a, b, c] = planar_.triangles[f];
      mesh_.triangles.push_back({vertex(a, 0), vertex(c, 0), vertex(b, 0)});
      mesh_.triangles.push_back({vertex(a, height_[f]), vertex(b, height_[f]), vertex(c, height_[f])});
    }
    for (const auto& [edge, high] : beside) {
      const auto other = beside.find({edge[1], edge[0]});
      const double low = other == beside.end() ? 0 : other->second;
      if (low < high) add_wall(edge[0], edge[1], low, high);
    }
    return std::move(mesh_);
  }

 private:
  std::uint32_t vertex(std::uint32_t point, double z) {
    const auto [at, added] = index_.try_emplace({point, z}, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (added) mesh_.vertices.emplace_back(planar_.points[point].x(), planar_.points[point].y(), z);
    return at->second;
  }

  // From low to high over an edge with the body on its left; its ends have a vertex at every height that is there.
  void add_wall(std::uint32_t a, std::uint32_t b, double low, double high) {
    const auto column = [&](std::uint32_t point) {
      std::vector<double> heights;
      for (const double z : at_vertex_[point])
        if (low <= z && z <= high) heights.push_back(z);
      return heights;
    };
    const std::vector<double> left = column(a), right = column(b);
    for (std::size_t i = 0, j = 0; i + 1 < left.size() || j + 1 < right.size();) {
      const bool goes_right = i + 1 == left.size() || (j + 1 < right.size() && right[j + 1] <= left[i + 1]);
      const std::uint32_t next = goes_right ? vertex(b, right[j + 1]) : vertex(a, left[i + 1]);
      mesh_.triangles.push_back({vertex(a, left[i]), vertex(b, right[j]), next});
      ++(goes_right ? j : i);
    }
  }

  Planar planar_;
  std::vector<double> height_;
  std::vector<std::set<double>> at_vertex_;
  std::map<std::pair<std::uint32_t, double>, std::uint32_t> index_;
  SurfaceMesh mesh_;
};

SurfaceMesh terrace(double width, double depth, const std::vector<Level>& levels) {
  return Terrace(rectangle(width, depth), levels).mesh();
}

Level box_on(double x, double y, double width, double depth, double height) {
  return {{rectangle_loop(Point(x, y), Point(x + width, y + depth))}, height};
}

SurfaceMesh refined(SurfaceMesh mesh, double longest) {
  std::vector<double> length(mesh.vertices.size(), longest);
  std::vector<FeatureEdge> features;
  halve_long_edges(mesh, length, features, 1, 1, 30);
  return mesh;
}

SurfaceMesh moved(SurfaceMesh mesh, const Vec3& way) {
  for (Vec3& v : mesh.vertices) v += way;
  return mesh;
}

void add(SurfaceMesh& mesh, const SurfaceMesh& other) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({n + a, n + b, n + c});
}

SurfaceMesh box(const Vec3& low, const Vec3& high) {
  const Vec3 size = high - low;
  return moved(extrude(triangulate(rectangle(size.x(), size.y()), std::nullopt), size.z(), 1), low);
}

// Compartments between walls.
SurfaceMesh tray(double width, double depth, double height, double wall, int columns, int rows) {
  std::vector<Level> levels{{{rectangle_loop(Point(0, 0), Point(width, depth))}, height}};
  const double w = (width - wall) / columns, d = (depth - wall) / rows;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) levels.push_back(box_on(wall + i * w, wall + j * d, w - wall, d - wall, wall));
  return terrace(width, depth, levels);
}

// Of a round box: walls between circles.
SurfaceMesh round_tray(double radius, double height, double wall, int corners) {
  const Point centre(0, 0);
  return Terrace({{circle(centre, radius, corners)}, {}},
                 {{{circle(centre, radius, corners)}, height}, {{circle(centre, radius - wall, corners)}, wall}})
      .mesh();
}

SurfaceMesh plate_with_holes(double spacing, int columns, int rows, double radius, int corners, double thickness) {
  Region region = rectangle(spacing * (columns + 1), spacing * (rows + 1));
  for (int i = 1; i <= columns; ++i)
    for (int j = 1; j <= rows; ++j) add_hole(region, Point(i * spacing, j * spacing), radius, corners);
  return extrude(triangulate(region, std::nullopt), thickness, 1);
}

Loop ellipse(Point centre, double a, double b, int corners) {
  Loop loop = circle(Point(0, 0), 1, corners);
  for (Point& p : loop) p = Point(centre.x() + a * p.x(), centre.y() + b * p.y());
  return loop;
}

// Two rims of thin bars, a bridge between them and two temples that stand up.
SurfaceMesh eyeglass(double bar, int corners) {
  const double a = 24, b = 18, gap = 16, top = 60;
  std::vector<Level> levels;
  std::vector<Level> rims;
  for (const double side : {-1.0, 1.0}) {
    const Point centre(side * (a + gap / 2), 0);
    rims.push_back({{ellipse(centre, a, b, corners), ellipse(centre, a - bar, b - bar, corners)}, bar});
    const double hinge = side * (2 * a + gap / 2 + bar);
    levels.push_back(box_on(std::min(hinge, hinge - side * 2.5 * bar), -bar / 2, 2.5 * bar, bar, bar));
    levels.push_back(box_on(std::min(hinge, hinge - side * bar), -bar / 2, bar, bar, top));
  }
  levels.push_back(box_on(-gap / 2 - bar / 2, -bar / 2, gap + bar, bar, bar));
  levels.insert(levels.end(), rims.begin(), rims.end());
  Region around = rectangle(4 * a + gap + 20, 2 * b + 20);
  for (Point& p : around.loops.front()) p = Point(p.x() - 2 * a - gap / 2 - 10, p.y() - b - 10);
  return Terrace(around, levels).mesh();
}

SurfaceMesh grille(int meshes, double pitch, double bar) {
  Region region = rectangle(meshes * pitch + bar, meshes * pitch + bar);
  for (int i = 0; i < meshes; ++i)
    for (int j = 0; j < meshes; ++j) {
      region.loops.push_back(
          rectangle_loop(Point(i * pitch + bar, j * pitch + bar), Point((i + 1) * pitch, (j + 1) * pitch)));
      region.hole_seeds.emplace_back((i + 0.5) * pitch + bar / 2, (j + 0.5) * pitch + bar / 2);
    }
  return extrude(triangulate(region, std::nullopt), bar, 1);
}

// A rectangle with round corners at a height.
std::vector<Vec3> round_rectangle(double half_width, double half_depth, double radius, int pieces, double z) {
  std::vector<Vec3> ring;
  for (int corner = 0; corner < 4; ++corner) {
    const double x = (corner == 0 || corner == 3 ? 1 : -1) * (half_width - radius);
    const double y = (corner < 2 ? 1 : -1) * (half_depth - radius);
    for (int i = 0; i <= pieces; ++i) {
      const double angle = (corner + static_cast<double>(i) / pieces) * std::numbers::pi / 2;
      ring.emplace_back(x + radius * std::cos(angle), y + radius * std::sin(angle), z);
    }
  }
  return ring;
}

// Through rings of as many points each, closed by a point at both ends.
SurfaceMesh lofted(const std::vector<std::vector<Vec3>>& rings, const Vec3& first, const Vec3& last) {
  SurfaceMesh mesh;
  const auto n = static_cast<std::uint32_t>(rings.front().size());
  for (const auto& ring : rings) mesh.vertices.insert(mesh.vertices.end(), ring.begin(), ring.end());
  for (std::uint32_t r = 0; r + 1 < rings.size(); ++r)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = r * n + i, b = r * n + (i + 1) % n;
      mesh.triangles.push_back({a, b, b + n});
      mesh.triangles.push_back({a, b + n, a + n});
    }
  const auto bottom = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(first);
  mesh.vertices.push_back(last);
  const auto top_ring = static_cast<std::uint32_t>((rings.size() - 1) * n);
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh.triangles.push_back({bottom, (i + 1) % n, i});
    mesh.triangles.push_back({bottom + 1, top_ring + i, top_ring + (i + 1) % n});
  }
  return mesh;
}

// An open box with a wall, whose edges have fillets; with a wall of 0 it is solid.
SurfaceMesh casing(double size, double wall, double fillet, int pieces) {
  const double half = size / 2, half_depth = size / 3, height = size / 3;
  std::vector<std::vector<Vec3>> rings;
  const auto ring = [&](double inset, double z) {
    rings.push_back(round_rectangle(half - inset, half_depth - inset, 2 * fillet, pieces, z));
  };
  const auto quarter = [&](double from_inset, double from_z, double to_inset, double to_z, bool inset_first) {
    for (int i = 0; i <= pieces; ++i) {
      const double angle = std::numbers::pi / 2 * i / pieces;
      const double s = std::sin(angle), c = 1 - std::cos(angle);
      ring(from_inset + (inset_first ? s : c) * (to_inset - from_inset),
           from_z + (inset_first ? c : s) * (to_z - from_z));
    }
  };
  quarter(fillet, 0, 0, fillet, true);
  quarter(0, height - fillet, fillet, height, false);
  if (wall == 0) return lofted(rings, Vec3(0, 0, 0), Vec3(0, 0, height));
  quarter(wall - fillet, height, wall, height - fillet, true);
  quarter(wall, wall + fillet, wall + fillet, wall, false);
  return lofted(rings, Vec3(0, 0, 0), Vec3(0, 0, wall));
}

// Strokes on a grid of 4 by 6, one letter beside the other.
std::vector<Loop> letters(const std::string& text, double size, double x0, double y0) {
  const std::map<char, std::vector<std::vector<std::array<double, 2>>>> shapes{
      {'E', {{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 2.5}, {3, 2.5}, {3, 3.5}, {1, 3.5}, {1, 5}, {4, 5}, {4, 6}, {0, 6}}}},
      {'F', {{{0, 0}, {1, 0}, {1, 2.5}, {3, 2.5}, {3, 3.5}, {1, 3.5}, {1, 5}, {4, 5}, {4, 6}, {0, 6}}}},
      {'A',
       {{{0, 0}, {1, 0}, {1.4, 1.5}, {2.6, 1.5}, {3, 0}, {4, 0}, {2.5, 6}, {1.5, 6}},
        {{1.7, 2.4}, {2.3, 2.4}, {2, 4}}}},
      {'N', {{{0, 0}, {1, 0}, {1, 4}, {3, 0}, {4, 0}, {4, 6}, {3, 6}, {3, 2}, {1, 6}, {0, 6}}}},
      {'Z', {{{0, 0}, {4, 0}, {4, 1}, {1.4, 1}, {4, 5}, {4, 6}, {0, 6}, {0, 5}, {2.6, 5}, {0, 1}}}},
      {'V', {{{1.5, 0}, {2.5, 0}, {4, 6}, {3, 6}, {2, 1.6}, {1, 6}, {0, 6}}}}};
  std::vector<Loop> loops;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == 'O') {
      const Point centre(x0 + size * (5.0 * static_cast<double>(i) + 2), y0 + size * 3);
      loops.push_back(ellipse(centre, 2 * size, 3 * size, 24));
      loops.push_back(ellipse(centre, 1.1 * size, 2 * size, 24));
    } else {
      for (const auto& shape : shapes.at(text[i])) {
        Loop loop;
        for (const auto& [x, y] : shape)
          loop.emplace_back(x0 + size * (5.0 * static_cast<double>(i) + x), y0 + size * y);
        loops.push_back(loop);
      }
    }
  return loops;
}

// Rows of text, cut in by `depth` or (below 0) standing out.
SurfaceMesh board(const std::vector<std::string>& rows, double letter, double thickness, double depth) {
  const double width = 5.0 * letter * static_cast<double>(rows.front().size()) + 4 * letter;
  const double height = 8.0 * letter * static_cast<double>(rows.size()) + 2 * letter;
  std::vector<Level> levels{{{rectangle_loop(Point(0, 0), Point(width, height))}, thickness}};
  Level text{{}, thickness - depth};
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (Loop& loop : letters(rows[r], letter, 2.5 * letter, letter * (2 + 8.0 * static_cast<double>(r))))
      text.loops.push_back(std::move(loop));
  levels.push_back(text);
  return terrace(width, height, levels);
}

// Boxes that overlap; corners of their union are a millionth apart, as where they were rounded differently.
SurfaceMesh near_flush_ribs(double off) {
  SurfaceMesh mesh = box({0, 0, 0}, {100, 60, 4});
  add(mesh, box({10, 5, 2}, {14, 55, 20}));
  add(mesh, box({14 - off, 20, 1}, {60, 24, 16}));
  add(mesh, box({56, 24 - off, 3}, {59, 50, 12}));
  return mesh;
}

SurfaceMesh near_flush_posts(double off) {
  SurfaceMesh mesh = box({0, 0, 0}, {80, 80, 10});
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const double x = 20.0 * i, y = 20.0 * j, d = off * (1 + i + 4 * j);
      add(mesh, box({x + 6, y + 6, 5}, {x + 14, y + 14, 25}));
      add(mesh, box({x + 14 - d, y + 7, 5}, {x + 18, y + 13, 22}));
    }
  return mesh;
}

// A wall that a post and a beam meet at nearly the same corner from both of its sides.
SurfaceMesh near_meeting_corners(double off) {
  SurfaceMesh mesh = box({0, 0, 0}, {60, 6, 40});
  add(mesh, box({10, 4, 10}, {20, 30, 20}));
  add(mesh, box({20 - off, 3, 20 - off}, {30, 30, 30}));
  add(mesh, box({30, -24, 10 + off}, {45, 2, 25}));
  add(mesh, box({45 - off, -24, 25 - off}, {55, 5, 35}));
  return mesh;
}

// A body of revolution with thorns on the faces of some rows: (radius, height) per row.
SurfaceMesh thorny(const std::vector<std::array<double, 2>>& profile, int corners, const std::vector<int>& rows,
                   int every, double length) {
  std::vector<std::vector<Vec3>> rings;
  for (const auto& [radius, z] : profile) {
    rings.emplace_back();
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners;
      rings.back().emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  SurfaceMesh mesh = lofted(rings, Vec3(0, 0, profile.front()[1]), Vec3(0, 0, profile.back()[1]));
  for (const int row : rows)
    for (int i = 0; i < corners; i += every) {
      const auto f = static_cast<std::size_t>(2 * (row * corners + i));
      const Triangle low = mesh.triangles[f], high = mesh.triangles[f + 1];
      const std::array<std::uint32_t, 4> quad{low[0], low[1], low[2], high[2]};
      Vec3 middle = Vec3::Zero();
      for (const std::uint32_t v : quad) middle += mesh.vertices[v] / 4;
      const Vec3 outward = (area_vector(mesh, low) + area_vector(mesh, high)).normalized();
      const auto apex = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(middle + length * (outward + Vec3(0, 0, 0.5)));
      mesh.triangles[f] = {quad[0], quad[1], apex};
      mesh.triangles[f + 1] = {quad[1], quad[2], apex};
      mesh.triangles.push_back({quad[2], quad[3], apex});
      mesh.triangles.push_back({quad[3], quad[0], apex});
    }
  return mesh;
}

const std::vector<std::array<double, 2>> queen{{14, 0},   {14, 3},   {12, 5}, {12, 7}, {9, 9},  {7, 14},   {6, 20},
                                               {5.5, 28}, {5.5, 36}, {6, 40}, {9, 42}, {9, 44}, {6.5, 46}, {7, 50},
                                               {8.5, 54}, {9, 57},   {6, 58}, {3, 60}, {2, 61}};
const std::vector<std::array<double, 2>> mine{{4, 0},     {8, 2},   {11, 5}, {12.5, 9},
                                              {12.5, 13}, {11, 17}, {8, 20}, {4, 22}};

void write_all(const std::function<void(const SurfaceMesh&, const char*)>& write) {
  const SurfaceMesh deep_tray = tray(160, 100, 30, 2, 4, 3), shallow_tray = tray(300, 200, 25, 3.2, 2, 1);
  write(deep_tray, "tray-deep-coarse");
  write(refined(deep_tray, 8), "tray-deep-fine");
  write(shallow_tray, "tray-shallow-coarse");
  write(refined(shallow_tray, 15), "tray-shallow-fine");
  write(round_tray(40, 35, 1.5, 48), "tray-round-coarse");
  write(plate_with_holes(6, 20, 10, 1, 12, 3), "holes-200-coarse");
  write(refined(plate_with_holes(6, 20, 10, 1, 16, 3), 3), "holes-200-fine");
  write(plate_with_holes(5, 20, 10, 1.5, 16, 1.5), "holes-sieve-coarse");
  SurfaceMesh rods = box({0, 0, 0}, {2, 2, 200});
  add(rods, moved(rods, {4000, 0, 0}));
  write(rods, "rods-two-coarse");
  write(refined(rods, 2), "rods-two-fine");
  SurfaceMesh unlike = refined(box({0, 0, 0}, {2, 2, 200}), 2);
  add(unlike, moved(refined(plate_with_holes(8, 3, 3, 2, 24, 4), 4), {2500, 300, 0}));
  write(unlike, "rods-and-plate-fine");
  write(eyeglass(1, 32), "bars-eyeglass-coarse");
  write(refined(eyeglass(1.6, 48), 2), "bars-eyeglass-fine");
  write(grille(6, 12, 1), "bars-grille-coarse");
  write(refined(grille(6, 12, 1), 3), "bars-grille-fine");
  write(casing(100, 4, 1, 4), "fillets-casing-coarse");
  write(refined(casing(100, 4, 1, 4), 6), "fillets-casing-fine");
  write(refined(casing(100, 0, 1, 3), 10), "fillets-block-fine");
  const SurfaceMesh text = board({"FEAZON", "NOVEZA"}, 1.5, 3, 0.6);
  write(text, "text-engraved-coarse");
  write(refined(text, 2), "text-engraved-fine");
  write(refined(board({"ZONE", "FAVE"}, 3, 4, -1), 4), "text-raised-fine");
  write(near_flush_ribs(1e-6), "shells-ribs-coarse");
  write(refined(near_flush_posts(1e-6), 5), "shells-posts-fine");
  write(near_meeting_corners(1e-6), "shells-corners-coarse");
  write(refined(near_meeting_corners(5e-6), 4), "shells-corners-fine");
  write(thorny(queen, 24, {15}, 2, 5), "thorns-queen-coarse");
  write(thorny(mine, 20, {1, 3, 5}, 4, 4), "thorns-mine-coarse");
  write(refined(thorny(queen, 24, {15}, 2, 5), 2), "thorns-queen-fine");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: benchmark_kinds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  try {
    write_all(
        [&](const SurfaceMesh& mesh, const char* name) { write_surface(mesh, folder / (std::string(name) + ".ply")); });
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "benchmark_kinds: %s\n", e.what());
    return 1;
  }
}
