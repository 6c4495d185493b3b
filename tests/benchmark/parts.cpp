// benchmark_parts FOLDER [FANDISK]: writes the mechanical parts of tests/benchmark/feature_table, and FANDISK with
// noise.
#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"
#include "tests/benchmark/planar_parts.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <vector>

namespace {

using namespace scan2fea;

SurfaceMesh flat(const Planar& planar) {
  SurfaceMesh mesh;
  for (const Point& p : planar.points) mesh.vertices.emplace_back(p.x(), p.y(), 0);
  mesh.triangles = planar.triangles;
  return mesh;
}

// Vertices that no triangle uses go, as those inside a tube's ends do.
SurfaceMesh compacted(const SurfaceMesh& mesh) {
  SurfaceMesh result;
  std::map<std::uint32_t, std::uint32_t> index;
  for (Triangle t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      const auto [at, added] = index.try_emplace(v, static_cast<std::uint32_t>(result.vertices.size()));
      if (added) result.vertices.push_back(mesh.vertices[v]);
      v = at->second;
    }
    result.triangles.push_back(t);
  }
  return result;
}

Region plate_with_holes(int corners) {
  Region region = rectangle(100, 60);
  for (const Point& p : {Point(15, 15), Point(85, 15), Point(15, 45), Point(85, 45)}) add_hole(region, p, 5, corners);
  add_hole(region, Point(50, 30), 14, 2 * corners);
  return region;
}

// An angle of two legs with a fillet between them, rounded ends and three holes.
Region bracket(int pieces) {
  Loop outline{Point(0, 0)};
  add_arc(outline, Point(72, 8), 8, -90, 0, pieces);
  add_arc(outline, Point(72, 17), 8, 0, 90, pieces);
  add_arc(outline, Point(37, 37), 12, 270, 180, pieces);
  add_arc(outline, Point(17, 52), 8, 0, 90, pieces);
  add_arc(outline, Point(8, 52), 8, 90, 180, pieces);
  Region region{{outline}, {}};
  for (const Point& p : {Point(12.5, 12.5), Point(60, 12.5), Point(12.5, 45)}) add_hole(region, p, 5, 4 * pieces);
  return region;
}

// A foot with two ribs, their tops round and their roots filleted, and holes through the foot and the ribs.
Region ribs(int pieces) {
  Loop outline{Point(0, 0), Point(90, 0), Point(90, 16)};
  for (const double x : {65.0, 25.0}) {
    add_arc(outline, Point(x + 11, 20), 4, 270, 180, pieces);
    add_arc(outline, Point(x, 40), 7, 0, 180, 2 * pieces);
    add_arc(outline, Point(x - 11, 20), 4, 0, -90, pieces);
  }
  outline.emplace_back(0, 16);
  Region region{{outline}, {}};
  for (const Point& p : {Point(10, 8), Point(45, 8), Point(80, 8), Point(25, 38), Point(65, 38)})
    add_hole(region, p, 4.5, 4 * pieces);
  return region;
}

SurfaceMesh cube_of_twelve() {
  return extrude(triangulate(rectangle(1, 1), std::nullopt), 1, 1);
}

SurfaceMesh noisy(SurfaceMesh mesh, double sigma) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0, sigma);
  for (Vec3& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) v[k] += normal(random);
  return mesh;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::fprintf(stderr, "usage: benchmark_parts FOLDER [FANDISK]\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  try {
    const auto write = [&](const SurfaceMesh& mesh, const char* name) { write_surface(mesh, folder / name); };
    const Region disc20{{circle(Point(0, 0), 20, 160)}, {}}, disc50{{circle(Point(0, 0), 50, 240)}, {}};
    write(cube_of_twelve(), "cube-12.ply");
    write(extrude(triangulate(rectangle(50, 50), 1.8), 50, 35), "cube.ply");
    write(extrude(triangulate(rectangle(100, 100), 2), 2, 2), "plate.ply");
    write(extrude(triangulate(disc20, 1.5), 60, 60), "cylinder.ply");
    write(extrude(triangulate(plate_with_holes(60), 1.5), 6, 6), "plate-with-holes.ply");
    write(compacted(extrude(triangulate(disc20, 2), 80, 80, false)), "tube.ply");
    write(flat(triangulate(rectangle(100, 60), 1.2)), "sheet.ply");
    write(extrude(triangulate(disc50, 2), 3, 3), "coin.ply");
    write(extrude(triangulate(bracket(24), 1.3), 10, 10), "bracket.ply");
    write(extrude(triangulate(bracket(4), std::nullopt), 10, 1), "coarse-bracket.ply");
    write(extrude(triangulate(ribs(24), 1.5), 12, 9), "ribs.ply");
    if (argc == 3) {
      const SurfaceMesh fandisk = read_surface(argv[2]);
      const double diagonal = bounding_box(fandisk.vertices).diagonal();
      write(fandisk, "fandisk.ply");
      write(noisy(fandisk, 0.0005 * diagonal), "fandisk-noise-0.05.ply");
      write(noisy(fandisk, 0.001 * diagonal), "fandisk-noise-0.1.ply");
    }
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "benchmark_parts: %s\n", e.what());
    return 1;
  }
}
