#include "preproc/mesh/read_cloud.hpp"

#include "preproc/mesh/scan_file.hpp"

namespace scan2fea {

PointCloud read_cloud(const std::filesystem::path& path) {
  return ScanFile(path).read_points();
}

NamedScan read_named_scan(const std::filesystem::path& path) {
  return ScanFile(path).read();
}

Scan read_scan(const std::filesystem::path& path) {
  NamedScan scan = read_named_scan(path);
  if (auto* cloud = std::get_if<PointCloud>(&scan)) return std::move(*cloud);
  return std::get<NamedSurface>(std::move(scan)).mesh;
}

}  // namespace scan2fea
