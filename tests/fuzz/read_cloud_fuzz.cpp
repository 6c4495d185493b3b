// Any bytes are a cloud whose coordinates can be relied on, or InvalidInput. SCAN2FEA_EXTENSION tells the reader, but
// for content that is certainly of another format.
#include "preproc/mesh/read_cloud.hpp"
#include "tests/fuzz/finding.hpp"
#include "tests/fuzz/input_on_disk.hpp"

#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan2fea;
  try {
    const PointCloud cloud = read_cloud(fuzz::input_on_disk("scan." SCAN2FEA_EXTENSION, data, size));
    fuzz::require(cloud.points.size() >= 4, "fewer than four points");
    for (const Vec3& p : cloud.points) fuzz::require(p.allFinite(), "a coordinate that is not finite");
    fuzz::require(cloud.normals.empty() || cloud.normals.size() == cloud.points.size(), "normals of some points only");
    for (const Vec3& n : cloud.normals)
      fuzz::require(n.isZero() || std::abs(n.norm() - 1) < 1e-6, "a normal that is not of unit length");
    fuzz::require(cloud.scanners.size() <= 1 || cloud.scanners.size() == cloud.points.size(),
                  "scanners of some points only");
    for (const Vec3& s : cloud.scanners) fuzz::require(s.allFinite(), "a scanner that is nowhere");
  } catch (const InvalidInput& error) {
    fuzz::require_told(error);
  }
  return 0;
}
