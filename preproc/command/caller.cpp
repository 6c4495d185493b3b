#include "preproc/command/caller.hpp"

#include "export/formats.hpp"
#include "preproc/command/console.hpp"
#include "preproc/mesh/error.hpp"

namespace scan2fea::command {

const MeshFile& mesh_in(const MemoryMesh& mesh) {
  if (const auto* held = std::get_if<MeshFile>(&mesh.held)) return *held;
  throw InvalidInput({.what = "a point cloud holds no triangles",
                      .where = mesh.name.string(),
                      .value = std::to_string(std::get<PointCloud>(mesh.held).points.size()) + " points",
                      .limit = {},
                      .advice = "reconstruct, first"});
}

NamedSurface surface_in(const MemoryMesh& mesh) {
  const MeshFile& held = mesh_in(mesh);
  if (const auto* surface = std::get_if<NamedSurface>(&held.mesh)) return *surface;
  Notes notes;
  NamedSurface boundary = named_boundary(std::get<TetMesh>(held.mesh), notes);
  for (const std::string& note : notes) warn(mesh.name.string() + ": " + note);
  return boundary;
}

ProgressDisplay& display_of(const DisplayFlags& flags, std::optional<ProgressDisplay>& own) {
  return flags.caller != nullptr ? flags.caller->display : own.emplace(flags);
}

}  // namespace scan2fea::command
