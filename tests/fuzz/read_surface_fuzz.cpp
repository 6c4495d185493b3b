// Any bytes are a surface whose indices and coordinates can be relied on, or InvalidInput. SCAN2FEA_EXTENSION tells the
// reader, but for content that is certainly of another format.
#include "preproc/mesh/read_surface.hpp"
#include "tests/fuzz/finding.hpp"
#include "tests/fuzz/input_on_disk.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan2fea;
  try {
    const SurfaceMesh mesh = read_surface(fuzz::input_on_disk("scan." SCAN2FEA_EXTENSION, data, size));
    fuzz::require(!mesh.triangles.empty(), "a surface without faces");
    for (const Vec3& p : mesh.vertices) fuzz::require(p.allFinite(), "a coordinate that is not finite");
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) fuzz::require(v < mesh.vertices.size(), "an index out of range");
  } catch (const InvalidInput& error) {
    fuzz::require_told(error);
  }
  return 0;
}
