// As read_mesh_fuzz.cpp, of a folder: form feeds part the bytes into its files.
#include "export/elmer.hpp"
#include "tests/fuzz/checked_mesh.hpp"
#include "tests/fuzz/input_on_disk.hpp"

#include <algorithm>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan2fea;
  const std::uint8_t* const end = data + size;
  for (const char* name : {"mesh.nodes", "mesh.elements", "mesh.boundary", "mesh.names"}) {
    const std::uint8_t* const stop = std::find(data, end, std::uint8_t{'\f'});
    fuzz::input_on_disk(name, data, static_cast<std::size_t>(stop - data));
    data = stop == end ? end : stop + 1;
  }
  try {
    const std::uint8_t any = '1';
    const MeshFile read = read_elmer(fuzz::input_on_disk("mesh.header", &any, 1));
    std::visit([](const auto& mesh) { fuzz::require_sound(mesh); }, read.mesh);
  } catch (const InvalidInput& error) {
    fuzz::require_told(error);
  }
  return 0;
}
