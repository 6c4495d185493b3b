// Any bytes are a mesh whose indices, coordinates and sets can be relied on, or InvalidInput. SCAN2FEA_EXTENSION tells
// the reader.
#include "export/formats.hpp"
#include "tests/fuzz/checked_mesh.hpp"
#include "tests/fuzz/input_on_disk.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan2fea;
  try {
    const MeshFile read = read_mesh(fuzz::input_on_disk("part." SCAN2FEA_EXTENSION, data, size));
    std::visit([](const auto& mesh) { fuzz::require_sound(mesh); }, read.mesh);
  } catch (const InvalidInput& error) {
    fuzz::require_told(error);
  }
  return 0;
}
