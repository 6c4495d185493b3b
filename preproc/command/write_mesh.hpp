// A mesh into a file, with all that its format holds of it: alike for the commands that make meshes and `convert`.
#pragma once

#include "export/formats.hpp"

#include <filesystem>
#include <optional>

namespace scan2fea::command {

bool holds_fields(const std::optional<Holdings>& holds);  // of a format that a surface, or tetrahedra, may have

// What the file holds besides the mesh and its sets, where its format does.
struct MeasuredFrom {
  const SurfaceMesh* reference = nullptr;             // for viewers, points' distances from it
  std::optional<std::size_t> measured_vertices = {};  // of an enriched surface: so many, the first, are of the scanner
};

// Notes what is lost. Throws as the writers of formats.hpp do.
Notes write_mesh(const TetMesh& mesh, const std::filesystem::path& file, const MeasuredFrom& from, FileOptions options);
Notes write_mesh(const NamedSurface& surface, const std::filesystem::path& file, const MeasuredFrom& from,
                 FileOptions options);

}  // namespace scan2fea::command
