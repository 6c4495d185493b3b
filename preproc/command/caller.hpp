// A program that has the work of a sub-command done in its own process: with meshes that it has in memory in place of
// files, and with what was measured and made handed back to it. The Python module is one.
#pragma once

#include "export/mesh_file.hpp"
#include "preproc/command/progress_display.hpp"
#include "preproc/mesh/point_cloud.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace scan2fea::command {

// With what a file would tell of it.
struct MemoryMesh {
  std::variant<MeshFile, PointCloud> held;
  std::filesystem::path name;       // of the file that it was read from, or what messages call it
  std::uint64_t first_element = 0;  // of that file; elements of what was made here are counted as arrays are
  // Of what was made here: what files say that they are of, and what viewers' files have the distances from.
  std::string provenance = {};
  std::shared_ptr<const SurfaceMesh> reference = {};
  std::optional<std::size_t> measured_vertices = {};  // of an enriched surface: so many, the first
};

using SharedMesh = std::shared_ptr<const MemoryMesh>;

struct Caller {
  std::vector<SharedMesh> inputs, references;  // of the files of the same place; null, or none, where that is read
  ProgressDisplay display{{.quiet = false, .verbose = false, .progress = ProgressMode::off}};
  std::vector<std::string> arguments = {};  // of a command line that does the same
  nlohmann::json figures = {};              // what --json writes
  SharedMesh made = {};

  const MemoryMesh* input(std::size_t place) const { return place < inputs.size() ? inputs[place].get() : nullptr; }
};

// The surface, or the boundary of tetrahedra with a warning of what is lost; those of the mesh, too. Throws
// InvalidInput for a cloud.
NamedSurface surface_in(const MemoryMesh& mesh);

// Throws InvalidInput for a cloud.
const MeshFile& mesh_in(const MemoryMesh& mesh);

// The display of the caller, or one on stderr that `own` is made to hold.
ProgressDisplay& display_of(const DisplayFlags& flags, std::optional<ProgressDisplay>& own);

}  // namespace scan2fea::command
