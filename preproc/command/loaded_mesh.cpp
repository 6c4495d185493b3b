#include "preproc/command/loaded_mesh.hpp"

#include "export/formats.hpp"
#include "export/units.hpp"
#include "preproc/command/body_inputs.hpp"
#include "preproc/command/piped_files.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/read_cloud.hpp"
#include "preproc/surface/repair/solid_volume.hpp"
#include "quality/curved_surface.hpp"

#include <utility>

namespace scan2fea::command {
namespace {

// Each closed by itself, so that where they touch no surface of one is that of the other.
double volume_of_bodies(const std::vector<Body>& bodies) {
  double sum = 0;
  for (const Body& body : bodies) sum += volume_of_solid(body.surface).value_or(enclosed_volume(body.surface));
  return sum;
}

LoadedReference load_reference(const std::filesystem::path& file) {
  require_no_pipe(file);
  if (find_format(file) != nullptr && find_format(file)->volume) return reference_of(load_mesh(file));
  NamedScan scan = read_named_scan(file);
  LoadedReference reference;
  if (auto* points = std::get_if<PointCloud>(&scan)) {
    reference.cloud = std::move(*points);
    return reference;
  }
  auto& surface = std::get<NamedSurface>(scan);
  return reference_of({.surface = std::move(surface.mesh),
                       .volume_mesh = {},
                       .face_sets = std::move(surface.face_sets),
                       .element_numbers = {},
                       .unit = std::move(surface.unit)});
}

}  // namespace

void require_no_pipe(const std::filesystem::path& file) {
  if (!is_pipe(file)) return;
  throw WrongUsage({.what = "only the input may come through a pipe",
                    .where = {},
                    .value = file.string(),
                    .limit = {},
                    .advice = "a file for what it is compared with"});
}

LoadedMesh load_mesh(const std::filesystem::path& file) {
  return loaded(read_mesh(file), first_element_of(file));
}

LoadedMesh loaded(MeshFile read, std::uint64_t first_element) {
  std::vector<std::uint32_t> numbers;
  if (first_element > 0) numbers.assign(read.numbers.elements.begin(), read.numbers.elements.end());
  if (auto* surface = std::get_if<NamedSurface>(&read.mesh))
    return {.surface = std::move(surface->mesh),
            .volume_mesh = {},
            .face_sets = std::move(surface->face_sets),
            .element_numbers = std::move(numbers),
            .unit = std::move(surface->unit)};
  LoadedMesh loaded;
  loaded.volume_mesh = std::get<TetMesh>(std::move(read.mesh));
  loaded.surface = boundary_surface(*loaded.volume_mesh);
  loaded.element_numbers = std::move(numbers);
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

void compare_with(const LoadedReference& reference, Subject& subject) {
  subject.reference = reference.surface ? &*reference.surface : nullptr;
  subject.cloud = reference.cloud ? &*reference.cloud : nullptr;
  subject.solid_volume = reference.solid_volume;
  subject.reference_is_of_bodies = reference.is_of_bodies;
}

namespace {

LoadedReference reference_in(const MemoryMesh& mesh) {
  LoadedReference reference;
  if (const auto* points = std::get_if<PointCloud>(&mesh.held))
    reference.cloud = *points;
  else
    reference = reference_of(loaded(mesh_in(mesh), 0));
  return reference;
}

}  // namespace

LoadedReference load_references(const std::vector<std::filesystem::path>& files, const std::string& unit,
                                const Caller* caller) {
  const auto load = [&](std::size_t place) {
    const bool is_given = caller != nullptr && place < caller->references.size() && caller->references[place];
    LoadedReference one = is_given ? reference_in(*caller->references[place]) : load_reference(files[place]);
    require_same_unit(unit, one.unit, files[place].string());
    return one;
  };
  if (files.empty()) return {};
  if (files.size() == 1) return load(0);
  LoadedReference all{.surface = SurfaceMesh{}, .cloud = {}, .solid_volume = 0, .is_of_bodies = true, .unit = unit};
  for (std::size_t r = 0; r < files.size(); ++r) {
    const LoadedReference one = load(r);
    if (!one.surface)
      throw WrongUsage({.what = "a point cloud among several references",
                        .where = files[r].string(),
                        .value = {},
                        .limit = {},
                        .advice = "surfaces, one for each body"});
    append(*all.surface, *one.surface);
    *all.solid_volume +=
        one.solid_volume ? *one.solid_volume : volume_of_solid(*one.surface).value_or(enclosed_volume(*one.surface));
  }
  return all;
}

LoadedReference reference_of(LoadedMesh mesh) {
  LoadedReference reference;
  reference.unit = mesh.unit;
  if (!mesh.volume_mesh) {
    Notes names;
    if (const std::vector<Body> bodies = bodies_of_groups(mesh.surface, mesh.face_sets, names); !bodies.empty()) {
      reference.is_of_bodies = true;
      reference.solid_volume = volume_of_bodies(bodies);
    }
    reference.surface = std::move(mesh.surface);
    return reference;
  }
  const TetMesh& volume = *mesh.volume_mesh;
  reference.is_of_bodies = volume.faces_between > 0;
  if (volume.order() == 2 || reference.is_of_bodies) reference.solid_volume = total_volume(volume);
  if (volume.order() == 1) {
    reference.surface = surfaces_of_bodies(volume);
    return reference;
  }
  const double tolerance = flat_enough_of_diagonal * bounding_box(mesh.surface.vertices).diagonal();
  reference.surface = flat_pieces(volume, tolerance, FacesBetween::of_either).mesh;
  return reference;
}

}  // namespace scan2fea::command
