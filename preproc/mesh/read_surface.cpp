#include "preproc/mesh/read_surface.hpp"

#include "preproc/mesh/cloud_formats.hpp"
#include "preproc/mesh/file_extension.hpp"
#include "preproc/mesh/surface_formats.hpp"
#include "preproc/mesh/unit_comment.hpp"

#include <string>

namespace scan2fea {

SurfaceMesh read_faces_and_vertices(const InputFile& file, std::vector<NamedSet>* sets, const TakeBlock& take) {
  if (is_ply(file)) return read_ply(file, sets, take);
  if (is_off(file)) return read_off(file, take);
  if (is_binary_stl(file)) return read_stl(file, sets, take);
  const std::string extension = extension_of_content(file.path());
  if (extension == ".stl") return read_stl(file, sets, take);
  if (extension == ".obj") return read_obj(file, sets, take);
  if (extension == ".ply") return read_ply(file, sets, take);
  if (extension == ".off") return read_off(file, take);
  file.fail(
      "neither the content nor the extension tells a surface format", extension, ".stl, .obj, .ply or .off",
      is_cloud_format(file) ? "scan2fea reconstruct, since this is a point cloud" : "converting it to one of these");
}

std::string unit_in_head(const InputFile& file) {
  constexpr std::size_t head = 1024;  // bytes
  return unit_in_comment(file.bytes().substr(0, head)).value_or("");
}

NamedSurface read_named_surface(const std::filesystem::path& path) {
  const InputFile file(path);
  NamedSurface surface;
  surface.mesh = read_faces_and_vertices(file, &surface.face_sets);
  if (surface.mesh.triangles.empty())
    file.fail("the file holds no faces", std::to_string(surface.mesh.vertices.size()) + " vertices", {},
              "scan2fea reconstruct, if this is a point cloud");
  surface.unit = unit_in_head(file);
  return surface;
}

SurfaceMesh read_surface(const std::filesystem::path& path) {
  return read_named_surface(path).mesh;
}

}  // namespace scan2fea
