#include "preproc/command/loaded_mesh.hpp"

#include "export/formats.hpp"
#include "preproc/mesh/read_cloud.hpp"
#include "quality/curved_surface.hpp"

#include <utility>

namespace scan2fea::command {

LoadedMesh load_mesh(const std::filesystem::path& file) {
  MeshFile read = read_mesh(file);
  if (first_element_of(file) == 0) read.element_numbers.clear();  // those of the reader alone
  if (auto* surface = std::get_if<NamedSurface>(&read.mesh))
    return {.surface = std::move(surface->mesh),
            .volume_mesh = {},
            .face_sets = std::move(surface->face_sets),
            .element_numbers = std::move(read.element_numbers),
            .unit = std::move(surface->unit)};
  LoadedMesh loaded;
  loaded.volume_mesh = std::get<TetMesh>(std::move(read.mesh));
  loaded.surface = boundary_surface(*loaded.volume_mesh);
  loaded.element_numbers = std::move(read.element_numbers);
  loaded.unit = loaded.volume_mesh->unit;
  return loaded;
}

Subject subject_of(const LoadedMesh& mesh) {
  Subject subject;
  subject.surface = &mesh.surface;
  subject.volume_mesh = mesh.volume_mesh ? &*mesh.volume_mesh : nullptr;
  subject.face_sets = &mesh.face_sets;
  subject.element_numbers = mesh.element_numbers;
  return subject;
}

LoadedReference load_reference(const std::filesystem::path& file) {
  if (find_format(file) != nullptr && find_format(file)->volume) return reference_of(load_mesh(file));
  Scan scan = read_scan(file);
  LoadedReference reference;
  if (auto* points = std::get_if<PointCloud>(&scan))
    reference.cloud = std::move(*points);
  else
    reference.surface = std::move(std::get<SurfaceMesh>(scan));
  return reference;
}

LoadedReference reference_of(LoadedMesh mesh) {
  LoadedReference reference;
  if (!mesh.volume_mesh || mesh.volume_mesh->order() == 1) {
    reference.surface = std::move(mesh.surface);
    return reference;
  }
  reference.solid_volume = total_volume(*mesh.volume_mesh);
  const double tolerance = flat_enough_of_diagonal * bounding_box(mesh.surface.vertices).diagonal();
  reference.surface = flat_pieces(*mesh.volume_mesh, tolerance).mesh;
  return reference;
}

}  // namespace scan2fea::command
