#include "export/surface_files.hpp"

#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/write_surface.hpp"

namespace scan2fea {

Notes write_plain_surface(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions&) {
  write_surface(surface.mesh, file);
  return {};
}

MeshFile read_plain_surface(const std::filesystem::path& file) {
  return {.mesh = NamedSurface{.mesh = read_surface(file), .node_sets = {}, .face_sets = {}, .unit = {}},
          .warnings = {}};
}

}  // namespace scan2fea
