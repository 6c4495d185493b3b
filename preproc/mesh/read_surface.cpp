#include "preproc/mesh/read_surface.hpp"

#include "preproc/mesh/cloud_formats.hpp"
#include "preproc/mesh/file_extension.hpp"
#include "preproc/mesh/surface_formats.hpp"

#include <string>

namespace scan2fea {

SurfaceMesh read_faces_and_vertices(const InputFile& file) {
  if (is_ply(file)) return read_ply(file);
  if (is_off(file)) return read_off(file);
  if (is_binary_stl(file)) return read_stl(file);
  const std::string extension = extension_of_content(file.path());
  if (extension == ".stl") return read_stl(file);
  if (extension == ".obj") return read_obj(file);
  if (extension == ".ply") return read_ply(file);
  if (extension == ".off") return read_off(file);
  file.fail(
      "neither the content nor the extension tells a surface format", extension, ".stl, .obj, .ply or .off",
      is_cloud_format(file) ? "scan2fea reconstruct, since this is a point cloud" : "converting it to one of these");
}

SurfaceMesh read_surface(const std::filesystem::path& path) {
  const InputFile file(path);
  SurfaceMesh mesh = read_faces_and_vertices(file);
  if (mesh.triangles.empty())
    file.fail("the file holds no faces", std::to_string(mesh.vertices.size()) + " vertices", {},
              "scan2fea reconstruct, if this is a point cloud");
  return mesh;
}

}  // namespace scan2fea
