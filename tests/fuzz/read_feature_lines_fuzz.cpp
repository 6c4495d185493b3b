// Any bytes are lines whose indices and coordinates can be relied on, or InvalidInput.
#include "preproc/surface/features/feature_file.hpp"
#include "tests/fuzz/finding.hpp"
#include "tests/fuzz/input_on_disk.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan2fea;
  try {
    const FeatureLines lines = read_feature_lines(fuzz::input_on_disk("creases.obj", data, size));
    for (const Vec3& p : lines.points) fuzz::require(p.allFinite(), "a coordinate that is not finite");
    for (const auto& segment : lines.segments)
      for (const std::uint32_t end : segment) fuzz::require(end < lines.points.size(), "an index out of range");
  } catch (const InvalidInput& error) {
    fuzz::require_told(error);
  }
  return 0;
}
