// Scans any closed surface in the computer (scanner.hpp):
//
//   make_cloud SURFACE OUT [--points N] [--positions N] [--noise PERCENT] [--outliers PERCENT]
//              [--outlier-kind view|near|box] [--patches N] [--seed N] [--normals] [--scanners]
//
// Percentages: the noise of the diagonal, the outliers of the points, which lie along the view, nearer to the surface,
// or anywhere in its box; --patches are places in which few points stay.
// OUT is XYZ: x y z, with --normals the normal, with --scanners where the scanner of the point stood, and 1 for an
// outlier, else 0. For one as large and bad as scans are:
//
//   make_cloud horse.ply cloud.xyz --points 2000000 --noise 0.05 --outliers 1 --patches 8
#include "examples/scanner.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/read_surface.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

namespace {

using namespace scan2fea;

struct Columns {
  bool normals = false, scanners = false;
};

void write(const ScannedCloud& scanned, const Columns& columns, const std::string& path) {
  OutputFile output(path);
  std::string text;
  if (columns.scanners)
    text = std::string("# x y z ") + (columns.normals ? "nx ny nz " : "") + "scanner_x scanner_y scanner_z outlier\n";
  for (std::size_t i = 0; i < scanned.cloud.points.size(); ++i) {
    const Vec3 &p = scanned.cloud.points[i], &n = scanned.cloud.normals[i], &from = scanned.cloud.scanners[i];
    char row[200];
    int size = std::snprintf(row, sizeof row, "%.9g %.9g %.9g", p.x(), p.y(), p.z());
    if (columns.normals)
      size += std::snprintf(row + size, sizeof row - std::size_t(size), " %.6f %.6f %.6f", n.x(), n.y(), n.z());
    if (columns.scanners)
      size +=
          std::snprintf(row + size, sizeof row - std::size_t(size), " %.9g %.9g %.9g", from.x(), from.y(), from.z());
    text.append(row, std::size_t(size));
    text += scanned.is_outlier[i] ? " 1\n" : " 0\n";
  }
  output.stream() << text;
  output.commit();
}

int usage() {
  std::fprintf(stderr,
               "usage: make_cloud SURFACE OUT [--points N] [--positions N] [--noise PERCENT] [--outliers PERCENT]\n"
               "                  [--outlier-kind view|near|box] [--patches N] [--seed N] [--normals] [--scanners]\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  std::map<std::string, double> value{{"--points", 50'000}, {"--positions", 6}, {"--noise", 0},
                                      {"--outliers", 0},    {"--patches", 0},   {"--seed", 1}};
  const std::map<std::string, OutlierKind> kinds{
      {"view", OutlierKind::along_view}, {"near", OutlierKind::near_surface}, {"box", OutlierKind::in_box}};
  OutlierKind kind = OutlierKind::along_view;
  Columns columns;
  if (argc < 3) return usage();
  for (int i = 3; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--normals" || name == "--scanners") {
      (name == "--normals" ? columns.normals : columns.scanners) = true;
      continue;
    }
    if (i + 1 == argc) return usage();
    if (name == "--outlier-kind") {
      const auto found = kinds.find(argv[++i]);
      if (found == kinds.end()) return usage();
      kind = found->second;
      continue;
    }
    char* end = nullptr;
    if (!value.contains(name)) return usage();
    value[name] = std::strtod(argv[++i], &end);
    if (*end != '\0' || !(value[name] >= 0 && value[name] <= 1e8)) return usage();
  }
  try {
    const ScannedCloud scanned =
        scan_surface(read_surface(argv[1]), {.points = static_cast<std::size_t>(value["--points"]),
                                             .positions = static_cast<int>(value["--positions"]),
                                             .noise = value["--noise"] / 100,
                                             .outliers = value["--outliers"] / 100,
                                             .outlier_kind = kind,
                                             .thinned_patches = static_cast<int>(value["--patches"]),
                                             .seed = static_cast<std::uint64_t>(value["--seed"])});
    write(scanned, columns, argv[2]);
    std::printf("%s: %zu points\n", argv[2], scanned.cloud.points.size());
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
  }
}
