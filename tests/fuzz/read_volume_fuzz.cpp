// Any bytes are a volume mesh whose indices and coordinates can be relied on, or InvalidInput. SCAN2FEA_EXTENSION tells
// the reader.
#include "export/formats.hpp"
#include "tests/fuzz/finding.hpp"
#include "tests/fuzz/input_on_disk.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace scan2fea;
  try {
    const TetMesh mesh = read_volume(fuzz::input_on_disk("part." SCAN2FEA_EXTENSION, data, size));
    fuzz::require(!mesh.tetrahedra.empty(), "a mesh without tetrahedra");
    fuzz::require(mesh.mid_edge_nodes.empty() || mesh.mid_edge_nodes.size() == mesh.tetrahedra.size(),
                  "mid-edge nodes of some elements only");
    for (const Vec3& p : mesh.nodes) fuzz::require(p.allFinite(), "a coordinate that is not finite");
    const auto require_nodes = [&](const auto& element) {
      for (const auto node : element) fuzz::require(node < mesh.nodes.size(), "a node out of range");
    };
    for (const auto& corners : mesh.tetrahedra) require_nodes(corners);
    for (const auto& mid_edges : mesh.mid_edge_nodes) require_nodes(mid_edges);
  } catch (const InvalidInput& error) {
    fuzz::require_told(error);
  }
  return 0;
}
