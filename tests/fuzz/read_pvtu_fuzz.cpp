// As read_mesh_fuzz.cpp, of an index and its two pieces: a form feed alone on its line parts the bytes into them.
#include "export/vtk.hpp"
#include "tests/fuzz/checked_mesh.hpp"
#include "tests/fuzz/input_on_disk.hpp"

#include <algorithm>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan2fea;
  constexpr std::string_view between = "\n\f\n";
  const std::uint8_t* const end = data + size;
  for (const char* name : {"part.pvtu", "part_0.vtu", "part_1.vtu"}) {
    const std::uint8_t* const stop = std::search(data, end, between.begin(), between.end());
    fuzz::input_on_disk(name, data, static_cast<std::size_t>(stop - data));
    data = stop == end ? end : stop + between.size();
  }
  try {
    const std::uint8_t none = 0;
    const MeshFile read = read_pvtu(fuzz::input_on_disk("none", &none, 1).replace_filename("part.pvtu"));
    std::visit([](const auto& mesh) { fuzz::require_sound(mesh); }, read.mesh);
  } catch (const InvalidInput& error) {
    fuzz::require_told(error);
  }
  return 0;
}
