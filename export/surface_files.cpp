#include "export/surface_files.hpp"

#include "preproc/mesh/read_surface.hpp"
#include "preproc/mesh/unit_comment.hpp"
#include "preproc/mesh/write_surface.hpp"

#include <fstream>

namespace scan2fea {

Notes write_plain_surface(const NamedSurface& surface, const std::filesystem::path& file, const FileOptions& options) {
  write_surface(surface.mesh, file, {.measured = {}, .unit = surface.unit, .ascii = options.ascii});
  return {};
}

std::string unit_in_head(const std::filesystem::path& file) {
  std::string head(1024, ' ');
  std::ifstream stream(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file)) return {};  // what is read of a pipe is gone
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  return unit_in_comment(head).value_or("");
}

MeshFile read_plain_surface(const std::filesystem::path& file) {
  return {
      .mesh = NamedSurface{.mesh = read_surface(file), .node_sets = {}, .face_sets = {}, .unit = unit_in_head(file)},
      .warnings = {}};
}

}  // namespace scan2fea
